#pragma once

#include "cases/case/boundary.hpp"

/// [[tool]] of a case file: a rigid body that presses against a body's surface without friction. Units: mm.
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

using Kind = std::variant<Sphere, Cylinder, Punch, Plane>;

} // namespace tools

/// A rigid tool, which at load factor s is s times its displacement from where it begins.
struct Tool {
  std::string name;
  tools::Kind shape;
  Eigen::Vector3d at = Eigen::Vector3d::Zero();           ///< mm, at load factor 0
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(); ///< mm at full load
  std::optional<Region> region{};                         ///< what it may touch; absent: all of the surface
  int steps = 1;                                          ///< load steps, at least
  Where where{};
};
SPRINGPROOF_FIELDS(Tool, name, shape, at, displacement, region, steps, where)

} // namespace springproof::cases
