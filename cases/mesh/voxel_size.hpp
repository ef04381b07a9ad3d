#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

/// Lengths of a picture's voxels, as every format that says them has to say them.
namespace springproof::cases {

/// What two statements of a length may differ by, relative, and an angle from a right one: half a voxel in
/// 500.
constexpr double voxel_tolerance = 1e-3;

/// @param unit  in small letters, by its symbol or name; where a header says none, "", "?" or "unknown", it
/// is mm
/// @throws std::runtime_error if it is no unit of length that is known
inline double millimetres_in(const std::string& unit) {
  struct Unit {
    const char* symbol;
    double millimetres;
  };
  static constexpr std::array<Unit, 25> units{{{"", 1},
                                               {"?", 1},
                                               {"unknown", 1},
                                               {"mm", 1},
                                               {"millimeter", 1},
                                               {"millimeters", 1},
                                               {"millimetre", 1},
                                               {"millimetres", 1},
                                               {"nm", 1e-6},
                                               {"um", 1e-3},
                                               {"\u00b5m", 1e-3},
                                               {"\u03bcm", 1e-3},
                                               {"micron", 1e-3},
                                               {"microns", 1e-3},
                                               {"micrometer", 1e-3},
                                               {"micrometers", 1e-3},
                                               {"micrometre", 1e-3},
                                               {"cm", 10},
                                               {"centimeter", 10},
                                               {"centimetre", 10},
                                               {"m", 1e3},
                                               {"meter", 1e3},
                                               {"meters", 1e3},
                                               {"metre", 1e3},
                                               {"metres", 1e3}}};
  for (const Unit& known : units)
    if (unit == known.symbol) return known.millimetres;
  throw std::runtime_error("has lengths in '" + unit.substr(0, 100) + "', must be nm, um, mm, cm or m");
}

/// The edges of a voxel from the steps between voxels.
/// @param steps  one along each axis of the array, in columns
/// @throws std::runtime_error unless they are at right angles
inline Eigen::Vector3d edges_of_voxel(const Eigen::Matrix3d& steps) {
  const Eigen::Vector3d edges = steps.colwise().norm();
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    if (!(std::abs(steps.col(a).dot(steps.col(b))) <= voxel_tolerance * edges[a] * edges[b]))
      throw std::runtime_error(
          "has sheared voxels: the axes of its array must be at right angles to each other; resample it");
  }
  return edges;
}

} // namespace springproof::cases
