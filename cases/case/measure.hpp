#pragma once

#include "cases/case/boundary.hpp"

/// [[measure]] and [[expect]] of a case file. Units: mm, N, MPa, degrees.
namespace springproof::cases {

/// A number of a quantity's values on several cells.
SPRINGPROOF_ENUMERATION(Statistic, largest, mean,
                        deviation ///< root of the mean square distance from the mean
)

SPRINGPROOF_ENUMERATION(Component, x, y, z, norm)
/// A component of a symmetric tensor. principal_1 is its largest eigenvalue, principal_3 its smallest.
SPRINGPROOF_ENUMERATION(TensorComponent, xx, yy, zz, xy, yz, xz, von_mises, principal_1, principal_2,
                        principal_3)

/// The kinds of measures. A kind has its `name` in case files, its `unit`, the part of a solution that it is
/// taken `from`, and the `regions` that it names.
namespace measures {

enum class From {
  nodes,              ///< displacements of single nodes; followed in time
  volume,             ///< volumes of cells; followed in time
  displacement_field, ///< a norm of all displacements, at the end of a motion
  body,               ///< any displacements; statics alone
  fields,             ///< Solution::fields, which a displacement alone does not tell; statics alone
  tools               ///< Solution::tools, likewise
};

template<class Kind>
using NoRegions = std::array<Region Kind::*, 0>;

struct Coordinate {
  static constexpr const char *name = "coordinate", *unit = "mm";
  static constexpr From from = From::nodes;
  Region node{};
  Axis axis = Axis::z;
  static constexpr std::array regions{&Coordinate::node};
};
SPRINGPROOF_FIELDS(Coordinate, node, axis)

struct Displacement {
  static constexpr const char *name = "displacement", *unit = "mm";
  static constexpr From from = From::nodes;
  Region node{};
  Component component = Component::norm;
  static constexpr std::array regions{&Displacement::node};
};
SPRINGPROOF_FIELDS(Displacement, node, component)

/// atan2(d_toward, d_up) of top - bottom.
struct Tilt {
  static constexpr const char *name = "tilt", *unit = "deg";
  static constexpr From from = From::nodes;
  Region top{}, bottom{};
  Axis toward = Axis::x, up = Axis::z;
  static constexpr std::array regions{&Tilt::top, &Tilt::bottom};
};
SPRINGPROOF_FIELDS(Tilt, top, bottom, toward, up)

/// Rotation of the segment from centre to node.
struct Twist {
  static constexpr const char *name = "twist", *unit = "deg";
  static constexpr From from = From::nodes;
  Region node{}, centre{};
  Axis axis = Axis::z; ///< looked along (thesis: beta is seen along z)
  static constexpr std::array regions{&Twist::node, &Twist::centre};
};
SPRINGPROOF_FIELDS(Twist, node, centre, axis)

struct Volume {
  static constexpr const char *name = "volume", *unit = "mm3";
  static constexpr From from = From::volume;
  static constexpr NoRegions<Volume> regions{};
};

struct DisplacementFieldL2 {
  static constexpr const char *name = "displacement_field_l2", *unit = "mm";
  static constexpr From from = From::displacement_field;
  static constexpr NoRegions<DisplacementFieldL2> regions{};
};

struct DisplacementFieldMax {
  static constexpr const char *name = "displacement_field_max", *unit = "mm";
  static constexpr From from = From::displacement_field;
  static constexpr NoRegions<DisplacementFieldMax> regions{};
};

/// The force of supports.
struct Reaction {
  static constexpr const char *name = "reaction", *unit = "N";
  static constexpr From from = From::fields;
  Region region{};
  Component component = Component::norm;
  static constexpr std::array regions{&Reaction::region};
};
SPRINGPROOF_FIELDS(Reaction, region, component)

struct StrainEnergy {
  static constexpr const char *name = "strain_energy", *unit = "N mm";
  static constexpr From from = From::fields;
  static constexpr NoRegions<StrainEnergy> regions{};
};

/// A component of the cells' tensors: in the cells that hold a point, or a statistic over several cells.
struct OfCells {
  TensorComponent component = TensorComponent::xx;
  Eigen::Vector3d point = Eigen::Vector3d::Zero(); ///< mm, with the body at rest
  Where point_where{};
  std::optional<Statistic> statistic{}; ///< over the cells with a face in the region, in place of the point's
  Region region{};                      ///< no name: all cells
  bool has_region() const { return region.near || !region.name.empty(); }
};
SPRINGPROOF_FIELDS(OfCells, component, point, point_where, statistic, region)

struct Stress : OfCells {
  static constexpr const char *name = "stress", *unit = "MPa";
  static constexpr From from = From::fields;
  static constexpr std::array regions{&OfCells::region};
};

struct Strain : OfCells {
  static constexpr const char *name = "strain", *unit = "1";
  static constexpr From from = From::fields;
  static constexpr std::array regions{&OfCells::region};
};

/// The largest curvature of the lines of nodes along an axis.
struct Curvature {
  static constexpr const char *name = "curvature", *unit = "1/mm";
  static constexpr From from = From::body;
  Region region{};
  Axis axis = Axis::x;
  static constexpr std::array regions{&Curvature::region};
};
SPRINGPROOF_FIELDS(Curvature, region, axis)

/// The force of a tool on the body.
struct ToolForce {
  static constexpr const char *name = "tool_force", *unit = "N";
  static constexpr From from = From::tools;
  std::size_t tool = 0; ///< index in Case::tools
  Component component = Component::norm;
  static constexpr NoRegions<ToolForce> regions{};
};
SPRINGPROOF_FIELDS(ToolForce, tool, component)

/// The moment of a tool's pressure on the body, about where the tool is.
struct ToolTorque {
  static constexpr const char *name = "tool_torque", *unit = "N mm";
  static constexpr From from = From::tools;
  std::size_t tool = 0; ///< index in Case::tools
  Component component = Component::norm;
  static constexpr NoRegions<ToolTorque> regions{};
};
SPRINGPROOF_FIELDS(ToolTorque, tool, component)

/// The area of the surface at rest that a tool presses on.
struct ContactArea {
  static constexpr const char *name = "contact_area", *unit = "mm2";
  static constexpr From from = From::tools;
  std::size_t tool = 0; ///< index in Case::tools
  static constexpr NoRegions<ContactArea> regions{};
};
SPRINGPROOF_FIELDS(ContactArea, tool)

/// How far the surface is inside a tool where it is deepest.
struct Penetration {
  static constexpr const char *name = "penetration", *unit = "mm";
  static constexpr From from = From::tools;
  std::size_t tool = 0; ///< index in Case::tools
  static constexpr NoRegions<Penetration> regions{};
};
SPRINGPROOF_FIELDS(Penetration, tool)

using Kind = std::variant<Coordinate, Displacement, Tilt, Twist, Volume, DisplacementFieldL2,
                          DisplacementFieldMax, Reaction, StrainEnergy, Stress, Strain, Curvature, ToolForce,
                          ToolTorque, ContactArea, Penetration>;

inline From from_of(const Kind& kind) {
  return std::visit([](const auto& one) { return one.from; }, kind);
}

/// Whether a motion has it: reactions, stresses and curvatures are measured in statics alone.
inline bool is_in_time(const Kind& kind) {
  return from_of(kind) != From::fields && from_of(kind) != From::body;
}

} // namespace measures

/// Whether a measure needs Solution::fields, which a displacement alone does not tell.
inline bool is_of_fields(const measures::Kind& kind) {
  return from_of(kind) == measures::From::fields;
}

/// Whether a measure needs Solution::tools.
inline bool is_of_tools(const measures::Kind& kind) {
  return from_of(kind) == measures::From::tools;
}

/// Whether a measure's error is the norm of a difference of fields.
inline bool is_field_norm(const measures::Kind& kind) {
  return from_of(kind) == measures::From::displacement_field;
}

struct Measure {
  std::string name;
  measures::Kind kind;
  Where where{};
  std::optional<OverTime> over_time{}; ///< dynamic cases only; not for norms of fields
};
SPRINGPROOF_FIELDS(Measure, name, kind, where, over_time)

/// Calls action(region, whether it is one node) for every region that a measure names.
/// @param measure  a Measure, constant or not
template<class AnyMeasure, class Action>
void for_each_region(AnyMeasure& measure, const Action& action) {
  const auto of_kind = [&](auto& kind) {
    for (const auto region : kind.regions) action(kind.*region, kind.from == measures::From::nodes);
  };
  std::visit(of_kind, measure.kind);
}

/// Where an expectation's interval comes from; reports count the kinds separately.
SPRINGPROOF_ENUMERATION(ReferenceKind, exact, converged, peer, published, requirement, regression)
SPRINGPROOF_ENUMERATION(Quantity, error_percent, msm, fem)

struct Expectation {
  std::string measure;
  Quantity quantity;
  std::array<double, 2> interval; ///< closed, lower <= upper; percent or the measure's unit
  ReferenceKind reference;
  std::string reason;
  Where where;
  std::array<Where, 2> ends_where = {}; ///< the interval's ends
};
SPRINGPROOF_FIELDS(Expectation, measure, quantity, interval, reference, reason, where, ends_where)

} // namespace springproof::cases
