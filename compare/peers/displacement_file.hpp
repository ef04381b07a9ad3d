#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

/// Displacements that another simulator computed, as they stand in a file.
namespace springproof::compare {

/// One node of the other program.
struct GivenDisplacement {
  Eigen::Vector3d position;     ///< at rest, mm
  Eigen::Vector3d displacement; ///< mm
  std::string where;            ///< for messages: "file:line", or "file: point 12"
  double rounding = 0;          ///< bound on the error of a position in single precision, mm
};

/// Reads a file by its ending.
/// .csv: the header x,y,z,ux,uy,uz and a line per node, mm.
/// .vtu: in any encoding that VTK reads; among its point data an array of three components, Float32 or
/// Float64, named msm_displacement or displacement, or the only one with three. Points with the same position
/// and displacement are one node.
/// @throws InputError saying where, what stands there and what is allowed
std::vector<GivenDisplacement> read_displacements(const std::string& path);

/// The two formats by themselves: the text of a file, and its name for messages.
std::vector<GivenDisplacement> read_displacement_csv(const std::string& text, const std::string& path);
std::vector<GivenDisplacement> read_displacement_vtu(const std::string& text, const std::string& path);

} // namespace springproof::compare
