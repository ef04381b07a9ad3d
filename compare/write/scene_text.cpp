#include "compare/write/scene_text.hpp"

#include "cases/scene/in_time.hpp"
#include "cases/scene/loads.hpp"
#include "cases/scene/masses.hpp"
#include "compare/write/columns.hpp"

#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

struct Body {
  Eigen::Vector3d size; ///< mm
  double volume = 0;    ///< mm³
};

Body measured_body(const cases::HexMesh& mesh) {
  Body body{cases::bounding_box(mesh.nodes).sizes()};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    body.volume += cases::cell_volume(cases::cell_vertices(mesh, c));
  return body;
}

/// All applied forces as one, N, and their moment about the middle of the body, N mm.
struct Resultant {
  Eigen::Vector3d centre;
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
};

/// Makes those components zero that rounding has left.
void remove_rounding(Eigen::Vector3d& vector, double scale) {
  for (double& component : vector)
    if (std::abs(component) < 1e-12 * scale) component = 0;
}

std::optional<Resultant> resultant_of(const cases::Scene& scene) {
  if (scene.loads.empty() || cases::has_load_histories(scene)) return std::nullopt;
  Resultant all{cases::bounding_box(scene.mesh.nodes).center()};
  double size = 0, turning = 0;
  for (const auto& [node, force] : cases::applied_forces(scene)) {
    const Eigen::Vector3d arm = scene.mesh.nodes[cases::index(node)] - all.centre;
    all.force += force;
    all.moment += arm.cross(force);
    size += force.norm();
    turning += arm.norm() * force.norm();
  }
  remove_rounding(all.force, size);
  remove_rounding(all.moment, turning);
  return all;
}

/// The faces that a load or a motion acts on: a patch has those of its faces, not of its circle.
struct Area {
  std::string name; ///< "load[0]"
  double size;      ///< mm²
};

std::vector<Area> areas_of(const cases::Scene& scene) {
  std::vector<Area> all;
  const auto add = [&](const char* list, const auto& conditions) {
    for (std::size_t i = 0; i < conditions.size(); ++i)
      if (const double area = cases::area(scene.mesh, conditions[i].selection); area > 0)
        all.push_back({fmt::format("{}[{}]", list, i), area});
  };
  add("load", scene.loads);
  add("moved", scene.moved);
  return all;
}

std::string components(const Eigen::Vector3d& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x(), v.y(), v.z());
}

Json components_to_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

} // namespace

void write_scene_text(std::ostream& out, const cases::Scene& scene) {
  const auto [size, volume] = measured_body(scene.mesh);
  write_wrapped(out,
                fmt::format("  body     {:.6g} x {:.6g} x {:.6g} mm, {:.6g} mm3, {} cells, {} nodes",
                            size.x(), size.y(), size.z(), volume, scene.mesh.cells.size(),
                            scene.mesh.nodes.size()),
                11);
  std::vector<std::string> loads;
  if (const auto all = resultant_of(scene)) {
    loads.push_back(fmt::format("applied force {} N", components(all->force)));
    loads.push_back(fmt::format("moment about {} {} N mm", components(all->centre), components(all->moment)));
  }
  for (const auto& [name, area] : areas_of(scene))
    loads.push_back(fmt::format("{} on {:.6g} mm2", name, area));
  if (!loads.empty()) write_wrapped(out, fmt::format("  loads    {}", fmt::join(loads, "; ")), 11);
}

Json body_to_json(const cases::Scene& scene) {
  const auto [size, volume] = measured_body(scene.mesh);
  return {{"size_mm", components_to_json(size)},
          {"volume_mm3", volume},
          {"cells", scene.mesh.cells.size()},
          {"nodes", scene.mesh.nodes.size()}};
}

Json loads_to_json(const cases::Scene& scene) {
  const auto all = resultant_of(scene);
  Json areas = Json::object();
  for (const auto& [name, area] : areas_of(scene)) areas[name] = area;
  return {{"force_N", all ? components_to_json(all->force) : Json()},
          {"moment_N_mm", all ? components_to_json(all->moment) : Json()},
          {"about_mm", all ? components_to_json(all->centre) : Json()},
          {"areas_mm2", areas}};
}

} // namespace springproof::compare
