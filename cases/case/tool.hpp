#pragma once

#include "cases/case/boundary.hpp"

/// [[tool]] of a case file: a rigid body that presses against a body's surface. Units: mm.
namespace springproof::cases {

/// What a tool can be. A shape has its `name` in case files and its keys; Tool::at says where it is.
namespace tools {

/// A ball; Tool::at is its centre.
struct Sphere {
  static constexpr const char* name = "sphere";
  double radius = 0; ///< mm, > 0
};
SPRINGPROOF_FIELDS(Sphere, radius)

/// A round bar without ends; Tool::at is a point of its axis.
struct Cylinder {
  static constexpr const char* name = "cylinder";
  double radius = 0;                               ///< mm, > 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); ///< unit length
};
SPRINGPROOF_FIELDS(Cylinder, radius, axis)

/// A round bar with one flat end and sharp edge; Tool::at is the centre of the flat end.
struct Punch {
  static constexpr const char* name = "punch";
  double radius = 0;                               ///< mm, > 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(); ///< unit length, out of the flat end, to the body
};
SPRINGPROOF_FIELDS(Punch, radius, axis)

/// A half space; Tool::at is a point of its boundary.
struct Plane {
  static constexpr const char* name = "plane";
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(); ///< unit length, out of the tool, to the body
};
SPRINGPROOF_FIELDS(Plane, normal)

/// What the triangles of a file (STL, OBJ, PLY, VTP) enclose; Tool::at is the file's origin.
struct Surface {
  static constexpr const char* name = "surface";
  NamedFile file{};
  double scale = 1;                            ///< mm of a unit of the file
  std::vector<Eigen::Vector3d> vertices{};     ///< mm, from Tool::at; make_scene() reads them
  std::vector<std::array<int, 3>> triangles{}; ///< numbers of vertices, from outside anticlockwise
};
SPRINGPROOF_FIELDS(Surface, file, scale, vertices, triangles)

using Kind = std::variant<Sphere, Cylinder, Punch, Plane, Surface>;

} // namespace tools

/// A rigid tool, which at load factor s is s times its displacement from where it begins; in a dynamic case
/// the factor is its history's, or its path says where it is.
struct Tool {
  std::string name;
  tools::Kind shape;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();           ///< mm, at load factor 0
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(); ///< mm at full load
  std::optional<Region> region{};                         ///< what it may touch; absent: all of the surface
  int steps = 1;                                          ///< load steps, at least
  double friction = 0;                                    ///< Coulomb's coefficient, 0 to most_friction
  History history{};                                      ///< in dynamic cases alone
  /// There too, in place of `at`, displacement and history: times (s), which ascend, and where it is (mm);
  /// straight between them, at rest before and after them.
  std::vector<std::array<double, 4>> path{};
  Where where{};

  /// Where it is, mm.  @param at_factor  load factor; in a dynamic case the time, s
  Eigen::Vector3d place(double at_factor) const {
    if (!path.empty()) return place_on_path(at_factor);
    return at + (history.is_given() ? history.at(at_factor) : at_factor) * displacement;
  }
  static constexpr double most_friction = 5; ///< far above rubber's on a rough road, about 1
  bool moves() const { return !displacement.isZero(0) || path.size() > 1; }

 private:
  Eigen::Vector3d place_on_path(double time) const;
};
SPRINGPROOF_FIELDS(Tool, name, shape, at, displacement, region, steps, friction, history, path, where)

} // namespace springproof::cases
