#pragma once

#include "cases/case/body.hpp"
#include "cases/case/dynamics.hpp"

#include <cmath>

/// Supports, motions, loads and added masses of a body, and their regions. Units: mm, N, MPa, degrees.
namespace springproof::cases {

/// The nodes that lie in a box and on or beyond a plane: all of them, or those of one class of cells.
struct Part {
  std::string cell_class; ///< a three-dimensional group's name; empty: every cell
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(-INFINITY); ///< mm; infinite where the box has no end
  Eigen::Vector3d upper = -lower;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< mm; on the plane
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(); ///< unit length, towards the part; zero: no plane
};
SPRINGPROOF_FIELDS(Part, cell_class, lower, upper, point, normal)

/// A plane and how far from it a node still counts as on it.
struct Plane {
  Eigen::Vector3d point;  ///< mm
  Eigen::Vector3d normal; ///< unit length; of either sense
  double tolerance;       ///< mm, > 0
};
SPRINGPROOF_FIELDS(Plane, point, normal, tolerance)

/// Part of a body: "z+ x-" on a box, the name of a physical group on a mesh, the node nearest to a point, a
/// patch of the surface around a point or on a plane, or the nodes of a class, in a box or beyond a plane.
struct Region {
  std::string name;                      ///< as written; for messages if a patch or part; empty for a node
  std::optional<Eigen::Vector3d> near{}; ///< mm
  Where where{};
  std::optional<double> radius{}; ///< mm, > 0: the boundary faces whose centre is at most that far from near
  std::optional<Part> part{};
  std::optional<double> tolerance{}; ///< mm, > 0: how far the node nearest to `near` may be; absent: 1e-6
  std::optional<Plane> plane{};      ///< the boundary faces all of whose vertices are on it
  bool is_in_cell = false;           ///< a measure's: the point `near` itself, which moves with its cell

  bool is_node() const { return near && !radius && !is_in_cell; }
  bool is_patch() const { return radius || plane; }
};
SPRINGPROOF_FIELDS(Region, name, near, where, radius, part, tolerance, plane, is_in_cell)

struct Fixed {
  Region region;
  std::array<bool, 3> components{true, true, true};
};
SPRINGPROOF_FIELDS(Fixed, region, components)

/// Where a motion fades out (thesis section 6.1.3, the scaled displacement method): its factor is 0 on and
/// behind a plane, 1 from `length` beyond it on, and linear between, the zone that is scaled.
struct ScaledDisplacement {
  Eigen::Vector3d point;  ///< mm; on the plane
  Eigen::Vector3d normal; ///< unit length, towards the part that moves as a whole
  double length;          ///< mm, > 0
  Where where;

  /// Returns the factor, in [0, 1], at a place in the body at rest (mm).
  double factor(const Eigen::Vector3d& rest) const {
    return std::clamp((rest - point).dot(normal) / length, 0.0, 1.0);
  }
};
SPRINGPROOF_FIELDS(ScaledDisplacement, point, normal, length, where)

/// A region of prescribed motion: at load factor s, s times a displacement or a rotation by s times an angle;
/// in a dynamic case s is its history.
struct Moved {
  Region region;
  std::array<bool, 3> components{true, true, true};       ///< all three when it is turned
  Eigen::Vector3d displacement = Eigen::Vector3d::Zero(); ///< mm at full load, on its components
  double angle = 0;                                       ///< degrees at full load, about axis through centre
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();        ///< unit length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();       ///< mm
  History history{};
  std::optional<ScaledDisplacement> scaled{}; ///< absent: the region moves as a whole
  int steps = 1;                              ///< load steps, at least
};
SPRINGPROOF_FIELDS(Moved, region, components, displacement, angle, axis, centre, history, scaled, steps)

/// What a load can be. A kind has its `name` in case files, what it acts `on`, and its `value` at full load.
namespace loads {

enum class On {
  nodes, ///< forces on nodes, as they are
  area,  ///< a dead traction on the rest area, integrated consistently
  masses ///< an acceleration of all that has mass; without a region
};

/// A force on every node of the region.
struct NodalForce {
  static constexpr const char* name = "nodal_force";
  static constexpr On on = On::nodes;
  Eigen::Vector3d value = Eigen::Vector3d::Zero(); ///< N
};
SPRINGPROOF_FIELDS(NodalForce, value)

/// A force shared equally by the region's nodes.
struct TotalForce {
  static constexpr const char* name = "total_force";
  static constexpr On on = On::nodes;
  Eigen::Vector3d value = Eigen::Vector3d::Zero(); ///< N
};
SPRINGPROOF_FIELDS(TotalForce, value)

struct Traction {
  static constexpr const char* name = "traction";
  static constexpr On on = On::area;
  Eigen::Vector3d value = Eigen::Vector3d::Zero(); ///< MPa
};
SPRINGPROOF_FIELDS(Traction, value)

/// A moment about an axis: a tangential traction that grows linearly with the radius.
struct Torque {
  static constexpr const char* name = "torque";
  static constexpr On on = On::area;
  double value = 0;                                 ///< N mm
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(); ///< mm
};
SPRINGPROOF_FIELDS(Torque, value, axis, centre)

struct Gravity {
  static constexpr const char* name = "gravity";
  static constexpr On on = On::masses;
  Eigen::Vector3d value = Eigen::Vector3d::Zero(); ///< m/s²
};
SPRINGPROOF_FIELDS(Gravity, value)

using Kind = std::variant<NodalForce, TotalForce, Traction, Torque, Gravity>;

/// Returns action(kind) if the load acts there, else a Result{}.
template<On on, class Result, class Action>
Result of_those_on(const Kind& kind, const Action& action) {
  const auto if_there = [&](const auto& one) -> Result {
    if constexpr (std::decay_t<decltype(one)>::on == on) return action(one);
    return Result{};
  };
  return std::visit(if_there, kind);
}

} // namespace loads

struct Load {
  Region region;
  loads::Kind kind;
  History history{};

  loads::On on() const {
    return std::visit([](const auto& one) { return one.on; }, kind);
  }
  bool is_zero() const {
    return std::visit([](const auto& one) { return one.value == 0. * one.value; }, kind);
  }
  void scale(double factor) {
    std::visit([=](auto& one) { one.value *= factor; }, kind);
  }
};
SPRINGPROOF_FIELDS(Load, region, kind, history)

/// Whether some load is a force on each node of its region, which has no limit under refinement.
inline bool has_nodal_forces(const std::vector<Load>& loads) {
  return std::any_of(loads.begin(), loads.end(),
                     [](const Load& load) { return std::holds_alternative<loads::NodalForce>(load.kind); });
}

/// A mass that moves with a region, without stiffness of its own.
struct AddedMass {
  Region region;
  double mass; ///< kg, > 0, shared equally by the region's nodes
};
SPRINGPROOF_FIELDS(AddedMass, region, mass)

} // namespace springproof::cases
