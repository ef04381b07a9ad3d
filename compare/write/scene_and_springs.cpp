#include "compare/write/write.hpp"

#include "cases/scene/loads.hpp"
#include "cases/scene/regions.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace springproof::compare {

namespace {

struct Body {
  Eigen::Vector3d size; ///< mm
  double volume = 0;    ///< mm³
};

Body measured_body(const cases::Mesh& mesh) {
  Body body{cases::bounding_box(mesh.nodes).sizes()};
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    body.volume += cases::cell_volume(cases::cell_corners(mesh, c));
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

std::string exponents_text(const msm::CellStiffness& k) {
  if (!k.exponents) return "";
  return fmt::format(", exponents {:.4g}", fmt::join(k.exponents->by_kind, ", "));
}

std::string cell_text(const msm::CellTerms& terms) {
  const std::array<std::string, 3> kind_names{"edges", "face diagonals", "internal diagonals"};
  std::map<std::pair<int, std::string>, int> n_of; // springs of one kind and stiffness, as printed
  std::vector<std::string> parts;
  for (const msm::CellSpring& spring : terms.springs)
    ++n_of[{msm::n_axes(spring), fmt::format("{:.4g} N/m", 1e3 * spring.stiffness)}];
  for (const auto& [spring, n] : n_of)
    parts.push_back(
        fmt::format("{} {} of {}", n, kind_names[static_cast<std::size_t>(spring.first - 1)], spring.second));
  for (const msm::CellMidline& midline : terms.midlines)
    parts.push_back(
        fmt::format("a midline along {} of {:.4g} N/m", "xyz"[midline.axis], 1e3 * midline.stiffness));
  if (!terms.tetrahedra.empty())
    parts.push_back(fmt::format("{} tetrahedra of biquadratic springs", terms.tetrahedra.size()));
  if (terms.volume != 0) parts.push_back(fmt::format("k_v = {:.4g} MPa", terms.volume));
  return fmt::format("{} in a cell", fmt::join(parts, ", "));
}

/// Whether every cell has springs of its own.
bool differs_by_cell(const msm::BodyTerms& terms) {
  return terms.kinds.size() > 2 && terms.kinds.size() == terms.kind_of_cell.size();
}

std::string cells_text(const msm::BodyTerms& terms) {
  std::size_t n_springs = 0, n_others = 0;
  std::array<double, 2> springs{INFINITY, 0}, volumes{INFINITY, -INFINITY};
  const auto extend = [](std::array<double, 2>& range, double value) {
    range = {std::min(range[0], value), std::max(range[1], value)};
  };
  for (const msm::CellTerms& cell : terms.kinds) {
    n_springs += cell.springs.size();
    n_others += cell.midlines.size() + cell.tetrahedra.size();
    for (const msm::CellSpring& spring : cell.springs) extend(springs, 1e3 * spring.stiffness);
    extend(volumes, cell.volume);
  }
  std::string text = fmt::format("springs of {} cells' own", terms.kinds.size());
  if (n_springs > 0)
    text += fmt::format(": {} parts of springs from {:.4g} to {:.4g} N/m", n_springs, springs[0], springs[1]);
  if (n_others > 0)
    text += fmt::format(", {} {}", n_others,
                        terms.kinds.front().tetrahedra.empty() ? "midlines"
                                                               : "tetrahedra of biquadratic springs");
  if (volumes[0] != 0 || volumes[1] != 0)
    text += fmt::format(", k_v = {:.4g} MPa{}{}", volumes[0],
                        volumes[1] > volumes[0] ? fmt::format(" to {:.4g} MPa", volumes[1]) : "",
                        terms.kinds.front().is_at_nodes ? " at the nodes" : "");
  return text;
}

Json cell_to_json(const msm::BodyTerms& terms) {
  const msm::CellTerms& cell = terms.kinds.front();
  Json springs = Json::array(), tetrahedra = springs, midlines = springs;
  for (const msm::CellSpring& spring : cell.springs) {
    springs.push_back({{"vertices", spring.vertices}, {"stiffness_N_per_m", 1e3 * spring.stiffness}});
    if (const char* name = msm::parameter_name(spring.law.kind)) springs.back()[name] = spring.law.parameter;
  }
  for (const msm::CellMidline& midline : cell.midlines)
    midlines.push_back(
        {{"axis", std::string(1, "xyz"[midline.axis])}, {"stiffness_N_per_m", 1e3 * midline.stiffness}});
  for (const msm::CellTetrahedron& tetrahedron : cell.tetrahedra)
    tetrahedra.push_back(
        {{"vertices", tetrahedron.vertices}, {"lambda_MPa", tetrahedron.lambda}, {"mu_MPa", tetrahedron.mu}});
  return {{"springs", springs},
          {"tetrahedra", tetrahedra},
          {"midlines", midlines},
          {"mirrored_from_cell_to_cell", terms.kinds.size() > 1 && !differs_by_cell(terms)},
          {"differs_from_cell_to_cell", differs_by_cell(terms)},
          {"boundary", cases::name_of(terms.boundary)}};
}

} // namespace

void write_scene_text(std::ostream& out, const cases::Scene& scene) {
  const auto [size, volume] = measured_body(scene.mesh);
  const std::string parts = cases::has_cells(scene.definition.body)
                                ? fmt::format("{:.6g} mm3, {} cells", volume, scene.mesh.cells.size())
                                : fmt::format("a network of {} springs without cells", scene.network.size());
  write_wrapped(out,
                fmt::format("  body     {:.6g} x {:.6g} x {:.6g} mm, {}, {} nodes", size.x(), size.y(),
                            size.z(), parts, scene.mesh.nodes.size()),
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

std::string stiffness_text(const msm::CellStiffness& k) {
  return fmt::format("k_e, k_f, k_d = {:.4g} N/m", fmt::join(scaled(k, 1e3).springs(), ", ")) +
         (k.midline != 0 ? fmt::format(", k_m = {:.4g} N/m", 1e3 * k.midline) : "") +
         (k.volume != 0 ? fmt::format(", k_v = {:.4g} MPa", k.volume) : "") + exponents_text(k);
}

std::string springs_text(const msm::DesignResult& design) {
  if (design.springs.network()) return "the springs of the case's file";
  const msm::BodyTerms* terms = design.springs.terms();
  if (terms && terms->boundary == msm::Boundary::whole)
    return fmt::format("every spring {:.4g} N/m", 1e3 * design.stiffness.internal_diagonal);
  return terms ? (differs_by_cell(*terms) ? cells_text(*terms) : cell_text(terms->kinds.front())) +
                     exponents_text(design.stiffness)
               : stiffness_text(design.stiffness);
}

Json springs_to_json(const msm::DesignResult& design) {
  const msm::CellStiffness& k = design.stiffness;
  Json springs{{"stiffness_N_per_m", nullptr}, {"volume_stiffness_MPa", k.volume}};
  if (design.springs.cells()) springs["stiffness_N_per_m"] = scaled(k, 1e3).springs();
  if (k.midline != 0) springs["midline_stiffness_N_per_m"] = 1e3 * k.midline;
  if (k.exponents) springs["exponents"] = k.exponents->by_kind;
  if (const msm::BodyTerms* terms = design.springs.terms()) {
    springs["volume_stiffness_MPa"] = terms->kinds.front().volume;
    springs["cell"] = cell_to_json(*terms);
  }
  return springs;
}

} // namespace springproof::compare
