#include "compare/export/export_springs.hpp"
#include "compare/export/package.hpp"

#include "compare/provenance/whole_file.hpp"
#include "compare/table/json.hpp"

#include <fmt/ostream.h>
#include <fmt/ranges.h>
#include <map>
#include <nlohmann/json.hpp>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

constexpr double thousand = 1e3; ///< mN of a N, kg of a tonne, mN/mm of a N/mm

/// Nodes by their constrained components, 1 or 0 each.
std::map<std::vector<int>, std::vector<std::size_t>> supports(const msm::Problem& problem) {
  std::map<std::vector<int>, std::vector<std::size_t>> by_components;
  for (std::size_t n = 0; n < problem.lattice.rest.size(); ++n)
    by_components[constrained(problem, n)].push_back(n);
  by_components.erase({0, 0, 0});
  return by_components;
}

Json history_to_json(const cases::History& history) {
  if (history.frequency != 0) return {{"sine", history.frequency}};
  return history.points;
}

Json forces_to_json(const std::vector<cases::NodeVector>& forces) {
  Json all = Json::array();
  for (const auto& [node, f] : forces)
    if (f != Vector3d::Zero()) all.push_back({node, thousand * f.x(), thousand * f.y(), thousand * f.z()});
  return all;
}

std::array<double, 3> numbers(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

Json moved_to_json(const cases::Scene::MovedNodes& moved, const msm::Points& rest) {
  const cases::Moved& motion = moved.motion;
  std::vector<double> parts;
  for (const int node : moved.selection.nodes)
    parts.push_back(motion.scaled ? motion.scaled->factor(rest[index(node)]) : 1);
  return {{"nodes", moved.selection.nodes},
          {"parts", parts},
          {"components", motion.components},
          {"displacement", numbers(motion.displacement)},
          {"angle", motion.angle},
          {"axis", numbers(motion.axis)},
          {"centre", numbers(motion.centre)},
          {"history", history_to_json(motion.history)}};
}

/// The same of every point of a scene without differences that inexpressible_in_sofa() refuses.
double mass_damping(const msm::Inertia& inertia) {
  return inertia.mass_damping.front() / inertia.mass.front();
}

Json motion_to_json(const ExportedMotion& motion, const msm::Points& rest) {
  Json masses = Json::array(), loads = Json::array(), moved = Json::array();
  for (const double mass : motion.inertia.mass) masses.push_back(thousand * mass);
  for (const auto& [history, force] : motion.inertia.loads)
    loads.push_back({{"history", history_to_json(history)}, {"forces", forces_to_json(force)}});
  for (const cases::Scene::MovedNodes& nodes : motion.moved) moved.push_back(moved_to_json(nodes, rest));
  return {{"scheme", cases::name_of(motion.dynamics.scheme.scheme)},
          {"step", motion.dynamics.step},
          {"end", motion.dynamics.end},
          {"mass_damping", mass_damping(motion.inertia)},
          {"stiffness_damping", motion.stiffness_damping},
          {"masses", masses},
          {"loads", loads},
          {"moved", moved}};
}

/// Rows of numbers as an array of arrays.
void write_rows(std::ostream& out, const NumberArray& rows) {
  const char* comma = "";
  out << "[";
  for (auto row = rows.values.begin(); row != rows.values.end(); row += std::ptrdiff_t(rows.columns))
    fmt::print(out, "{}\n[{}]", std::exchange(comma, ","),
               fmt::join(row, row + std::ptrdiff_t(rows.columns), ", "));
  out << "]";
}

/// What SpringForceField does not have, as arrays of a client's scene; mm and mN.
void write_terms(std::ostream& out, const msm::Lattice& others) {
  const char* comma = "";
  out << ",\n\"terms\": {";
  for (const auto& [name, array] : lattice_arrays(others, {1, thousand})) {
    fmt::print(out, "{}\n\"{}\": ", std::exchange(comma, ","), name);
    write_rows(out, array);
  }
  out << "}";
}

/// Vertex, node, weight; and triangles.
void write_skin(std::ostream& out, const mechanics::EmbeddedSurface& skin) {
  out << ",\n\"skin\": {\"weights\": ";
  write_rows(out, skin_weights(skin));
  out << ",\n\"triangles\": " << Json(skin.rest.triangles).dump() << "}";
}

void write_json(std::ostream& out, const std::string& name, const msm::Problem& problem,
                const ExportedBody& body, const ExportedMotion* motion) {
  const char* comma = "";
  const auto begin_list = [&](const char* key) {
    fmt::print(out, ",\n\"{}\": [", key);
    comma = "";
  };
  const auto next = [&] { out << std::exchange(comma, ",") << "\n"; };
  const msm::Points& rest = problem.lattice.rest;
  out << "{\"schema\": 3,\n\"case\": "
      << nlohmann::json(name).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace)
      << ",\n\"units\": \"mm, mN, kg, s\"";
  begin_list("positions");
  for (const Vector3d& x : rest) next(), fmt::print(out, "[{}, {}, {}]", x.x(), x.y(), x.z());
  out << "]";
  // Node, mm from its rest position: a motion where it starts, an equilibrium with its moved nodes in place.
  begin_list("start");
  const msm::Points start = motion ? motion->start : prescribed(problem);
  for (std::size_t n = 0; n < start.size(); ++n)
    if (const Vector3d& u = start[n]; u != Vector3d::Zero())
      next(), fmt::print(out, "[{}, {}, {}, {}]", n, u.x(), u.y(), u.z());
  out << "]";
  begin_list("springs"); // node, node, mN/mm, mm
  msm::Lattice others = problem.lattice;
  others.links.clear();
  for (const msm::Link& link : problem.lattice.links)
    if (link.spring.law.kind == msm::LawKind::hooke)
      next(), fmt::print(out, "[{}, {}, {}, {}]", link.i, link.j, thousand * link.spring.stiffness,
                         link.spring.rest_length);
    else
      others.links.push_back(link);
  out << "]";
  write_terms(out, others);
  write_skin(out, body.skin);
  begin_list("supports");
  for (const auto& [components, nodes] : supports(problem))
    next(), fmt::print(out, "{{\"directions\": [{}], \"nodes\": [{}]}}", fmt::join(components, ", "),
                       fmt::join(nodes, ", "));
  out << "],\n\"loads\": " << (motion ? Json::array() : forces_to_json(problem.force)).dump();
  out << ",\n\"motion\": " << (motion ? motion_to_json(*motion, rest) : Json()).dump() << "}\n";
}

} // namespace

std::vector<std::string> inexpressible_in_sofa(const ExportedMotion& motion) {
  const msm::Inertia& inertia = motion.inertia;
  std::vector<std::string> all;
  const cases::Scheme scheme = motion.dynamics.scheme.scheme;
  if (scheme != cases::Scheme::implicit_euler && scheme != cases::Scheme::bdf2)
    all.push_back(
        fmt::format("steps of {} (--set 'dynamics={{scheme=\"bdf2\", step={}, end={}, start=\"{}\"}}' "
                    "takes others, which SOFA has, as implicit_euler)",
                    cases::name_of(scheme), motion.dynamics.step, motion.dynamics.end,
                    cases::name_of(motion.dynamics.start)));
  if (!inertia.cell_mass.empty())
    all.emplace_back("consistent masses (--set msm.mass=cells has lumped ones)");
  const double ratio = mass_damping(inertia);
  for (std::size_t p = 0; p < inertia.mass.size(); ++p)
    if (!(std::abs(inertia.mass_damping[p] - ratio * inertia.mass[p]) <= 1e-9 * ratio * inertia.mass[p])) {
      all.emplace_back("mass_damping of some masses and not of others (several materials, or [[mass]])");
      break;
    }
  if (motion.has_memory) all.emplace_back("prony, the materials' memory");
  if (!motion.has_one_stiffness_damping) all.emplace_back("several materials' stiffness_damping");
  if (motion.stiffness_damping > 0 && !motion.moved.empty())
    all.emplace_back("stiffness_damping beside moved regions, whose velocity SOFA takes for 0");
  return all;
}

std::vector<std::string> write_sofa_files(const std::string& folder, const std::string& name,
                                          const msm::Problem& problem, const ExportedBody& body,
                                          const ExportedMotion* motion) {
  write_file(folder + "/scene.json",
             [&](std::ostream& out) { write_json(out, name, problem, body, motion); });
  copy_program(folder, "export", "sofa_scene.py", "scene.py");
  const std::size_t n_terms = n_other_terms(problem.lattice);
  std::vector<std::string> said{
      fmt::format("scene.json: {} nodes, {} springs, supports, loads{}; mm, mN, kg, s",
                  problem.lattice.rest.size(), problem.lattice.links.size(),
                  motion ? fmt::format(", masses, damping, steps of {} s by {}", motion->dynamics.step,
                                       cases::name_of(motion->dynamics.scheme.scheme))
                         : std::string(", in equilibrium")),
      "scene.py: reads scene.json; runSofa scene.py (SOFA v25.06 or newer, with SofaPython3)",
      write_references(folder, problem.lattice, thousand)};
  if (n_terms > 0)
    said.push_back(fmt::format(
        "{} terms that no component of SOFA has are a force field in numpy, in scene.py", n_terms));
  if (motion && motion->stiffness_damping > 0)
    said.emplace_back(
        "stiffness_damping is of the body as it is in SOFA, of the body at rest here: motions of "
        "large strains or turns differ");
  return said;
}

} // namespace springproof::compare
