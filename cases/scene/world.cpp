#include "cases/scene/world.hpp"

#include "cases/scene/regions.hpp"

#include <fmt/format.h>
#include <tuple>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

/// Puts what a case has in world coordinates into those of the body.
struct LeaveWorld {
  const Placement& placement;

  void point(Vector3d& point) const { point = placement.to_body(point); }
  void direction(Vector3d& direction) const { direction = placement.turned(direction); }

  /// Puts a box along axes of the world onto those of the array; its ends may be infinite.
  void box(Vector3d& lower, Vector3d& upper, const Where& where) const {
    const Vector3d nowhere = Vector3d::Constant(INFINITY);
    if (lower == -nowhere && upper == nowhere) return;
    const Vector3d from = lower - placement.corner, to = upper - placement.corner;
    for (int a = 0; a < 3; ++a) {
      int along = 0;
      const Vector3d& axis = placement.axes[static_cast<std::size_t>(a)];
      if (axis.cwiseAbs().maxCoeff(&along) != 1)
        refuse(where,
               "has a box along the axes of the world, and the picture's array lies askew, its {} along "
               "({:.6g}); must be a class, planes (beyond), or a box with frame = \"grid\" in [body]",
               name_of(static_cast<Axis>(a)), fmt::join(axis, ", "));
      std::tie(lower[a], upper[a]) = std::minmax(axis[along] * from[along], axis[along] * to[along]);
    }
  }

  void region(Region& region) const {
    if (region.near) point(*region.near);
    if (region.plane) {
      point(region.plane->point);
      direction(region.plane->normal);
    }
    if (!region.part) return;
    box(region.part->lower, region.part->upper, region.where);
    point(region.part->point);
    direction(region.part->normal);
  }

  void moved(Moved& moved) const {
    direction(moved.displacement);
    direction(moved.axis);
    point(moved.centre);
    if (moved.scaled) {
      point(moved.scaled->point);
      direction(moved.scaled->normal);
    }
    for (int a = 0; a < 3; ++a) {
      if (moved.components[static_cast<std::size_t>(a)]) continue;
      if (!(std::abs(moved.displacement[a]) <= 1e-9 * moved.displacement.norm())) // more than rounding
        refuse(
            moved.region.where,
            "displacement is ({:.6g}) along the axes of the picture's array, which components name; must be "
            "0 in the components that are not moved",
            fmt::join(moved.displacement, ", "));
      moved.displacement[a] = 0;
    }
  }

  void tool(Tool& tool) const {
    point(tool.at);
    direction(tool.displacement);
    for (auto& [time, x, y, z] : tool.path) {
      Vector3d place(x, y, z);
      point(place);
      std::tie(x, y, z) = std::tie(place.x(), place.y(), place.z());
    }
    const auto of_shape = [&](auto& shape) {
      using Shape = std::decay_t<decltype(shape)>;
      if constexpr (std::is_same_v<Shape, tools::Cylinder> || std::is_same_v<Shape, tools::Punch>)
        direction(shape.axis);
      if constexpr (std::is_same_v<Shape, tools::Plane>) direction(shape.normal);
      if constexpr (std::is_same_v<Shape, tools::Surface>)
        for (Vector3d& vertex : shape.vertices) direction(vertex);
    };
    std::visit(of_shape, tool.shape);
  }

  void material(Material& material) const {
    if (auto* const fibrous = std::get_if<TransverselyIsotropic>(&material)) direction(fibrous->fibre);
  }

  void load(Load& load) const {
    const auto kind = [&](auto& one) {
      if constexpr (std::is_same_v<std::decay_t<decltype(one)>, loads::Torque>) {
        direction(one.axis);
        point(one.centre);
      } else {
        direction(one.value);
      }
    };
    std::visit(kind, load.kind);
  }

  void measure(Measure& measure) const {
    const auto kind = [&](auto& one) {
      if constexpr (std::is_base_of_v<measures::OfCells, std::decay_t<decltype(one)>>) point(one.point);
    };
    std::visit(kind, measure.kind);
  }
};

} // namespace

std::optional<Placement> leave_world(Case& definition, std::vector<std::string>& remarks) {
  if (!is_in_world(definition.body)) return std::nullopt;
  const Labels& labels = std::get<Labels>(definition.body);
  const Placement placement = placement_of(labels);
  const auto& [x, y, z] = placement.axes;
  remarks.push_back(fmt::format(
      "frame = \"world\", by the {} of code {}: the body's x, y, z, which faces, components and results are "
      "along, begin at ({:.6g}) of the world and run along ({:.6g}), ({:.6g}) and ({:.6g})",
      placement.is_by_sform ? "sform" : "qform", placement.code, fmt::join(placement.corner, ", "),
      fmt::join(x, ", "), fmt::join(y, ", "), fmt::join(z, ", ")));
  definition.body = on_grid(labels, placement);
  const LeaveWorld leave{placement};
  for_each_region_of(definition, [&](Region& region) { leave.region(region); });
  leave.material(definition.material);
  for (RegionMaterial& region : definition.region_materials) {
    leave.material(region.material);
    leave.box(region.lower, region.upper, region.where);
  }
  for (Removed& piece : definition.removed) leave.box(piece.lower, piece.upper, piece.where);
  for (Moved& moved : definition.moved) leave.moved(moved);
  for (Load& load : definition.loads) leave.load(load);
  for (Tool& tool : definition.tools) leave.tool(tool);
  for (Measure& measure : definition.measures) leave.measure(measure);
  for (Landmark& landmark : definition.landmarks) leave.point(landmark.point);
  return placement;
}

} // namespace springproof::cases
