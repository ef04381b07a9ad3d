#include "compare/peers/getfem.hpp"

#include "cases/case/installation.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/loads.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/solve.hpp"
#include "compare/table/array_message.hpp"
#include "mechanics/elastic_moduli.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr const char* python = "/usr/bin/python3"; // Debian's, which has Debian's modules
constexpr int no_getfem = 3;                       // exit status of getfem_peer.py

/// Whether quadratic elements need a pressure beside their displacement.
bool needs_pressure(const cases::Scene& scene) {
  constexpr double most = 0.4; // Poisson's ratio, up to which they do well without
  const auto materials = cases::materials_of(scene.definition);
  return std::any_of(materials.begin(), materials.end(), [](const cases::Material& material) {
    return cases::poissons_ratio_of(material) > most;
  });
}

Json moduli_to_json(const cases::Material& material) {
  const auto rest = cases::hyperelastic_rest(material);
  const auto moduli = rest ? mechanics::elastic_moduli(*rest)
                           : mechanics::elastic_moduli(std::get<cases::LinearElastic>(material));
  Json json{{"mu", moduli.mu}, {"kappa", moduli.kappa}};
  if (const auto* ogden = std::get_if<cases::Ogden>(&material))
    for (std::size_t i = 0; i < ogden->mu.size(); ++i)
      json["terms"].push_back({ogden->mu[i], ogden->alpha[i]});
  if (const auto* yeoh = std::get_if<cases::Yeoh>(&material))
    json["yeoh"] = {yeoh->c10, yeoh->c20, yeoh->c30};
  return json;
}

/// The numbers of true components.
Json axes_of(const std::array<bool, 3>& components) {
  Json axes = Json::array();
  for (int a = 0; a < 3; ++a)
    if (components[static_cast<std::size_t>(a)]) axes.push_back(a);
  return axes;
}

Json vector_to_json(const Vector3d& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// Adds faces, edges and nodes.  @return the number of this part of the body
std::size_t add_part(ArrayMessage& message, const cases::Selection& selection) {
  const std::size_t number = message.header["parts"].size();
  Json names = Json::array();
  const auto add_all = [&](const auto& all, const char* kind) {
    if (all.empty()) return;
    NumberArray rows{all.begin()->size()};
    for (const auto& one : all) rows.add_nodes(one);
    names.push_back(fmt::format("{}_{}", kind, number));
    message.add(names.back(), rows);
  };
  add_all(selection.faces, "faces");
  add_all(selection.edges, "edges");
  std::vector<std::array<int, 1>> nodes;
  for (const int node : selection.nodes) nodes.push_back({node});
  add_all(nodes, "nodes");
  message.header["parts"].push_back(names);
  return number;
}

/// Tractions are linear functions of the point: their values at four places tell them.
Json load_to_json(const std::function<Vector3d(const Vector3d&)>& traction) {
  const Vector3d constant = traction(Vector3d::Zero());
  Json gradient = Json::array();
  for (int a = 0; a < 3; ++a) gradient.push_back(Json::array());
  for (int x = 0; x < 3; ++x) {
    const Vector3d slope = traction(Vector3d::Unit(x)) - constant;
    for (int a = 0; a < 3; ++a) gradient[static_cast<std::size_t>(a)].push_back(slope[a]);
  }
  return {{"constant", vector_to_json(constant)}, {"gradient", gradient}};
}

void add_tractions(ArrayMessage& message, const cases::Scene& scene) {
  Json& loads = message.header["loads"] = Json::array();
  for (const auto& applied : scene.loads) {
    const auto traction = cases::surface_traction(scene.mesh, applied);
    if (!traction) continue;
    cases::Selection faces;
    faces.faces = applied.selection.faces;
    Json load = load_to_json(traction);
    load["parts"] = add_part(message, faces);
    loads.push_back(load);
  }
  message.header["acceleration"] = vector_to_json(cases::gravity(scene));
}

void add_constraints(ArrayMessage& message, const cases::Scene& scene) {
  Json &supports = message.header["supports"] = Json::array(),
       &motions = message.header["motions"] = Json::array();
  for (const auto& [selection, components] : scene.constrained)
    supports.push_back({{"components", axes_of(components)}, {"parts", add_part(message, selection)}});
  for (const auto& [selection, motion] : scene.moved)
    motions.push_back({{"components", axes_of(motion.components)},
                       {"displacement", vector_to_json(motion.displacement)},
                       {"angle", motion.angle},
                       {"axis", vector_to_json(motion.axis)},
                       {"centre", vector_to_json(motion.centre)},
                       {"parts", add_part(message, selection)}});
}

void add_laws(ArrayMessage& message, const cases::Scene& scene) {
  const std::vector<cases::Material> materials = cases::materials_of(scene.definition);
  std::vector<double> densities(materials.size(), 0.);
  NumberArray of_cells{1};
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const int material = cases::material_of(scene, c);
    of_cells.add({double(material)});
    densities[cases::index(material)] = cases::dynamics_of(scene, c).density;
  }
  message.add("material_of_cell", of_cells);
  Json& all = message.header["materials"] = Json::array();
  for (std::size_t m = 0; m < materials.size(); ++m) {
    all.push_back(moduli_to_json(materials[m]));
    all.back()["density"] = densities[m];
  }
}

cases::Solution solution_of(const ReadMessage& message, const Json& mesh_solved, const cases::Mesh& mesh) {
  const auto array = [&](const char* kind, std::size_t n) -> const std::vector<double>& {
    const auto name = fmt::format("{}_{}", kind, mesh_solved.at("refine").get<int>());
    const std::vector<double>& values = message.arrays.at(name).values;
    const bool are_finite =
        std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
    if (values.size() != n || !are_finite) throw std::runtime_error(name + " is not of this mesh");
    return values;
  };
  cases::Solution solution;
  const std::vector<double>& u = array("displacement", 3 * mesh.nodes.size());
  for (std::size_t n = 0; n < u.size(); n += 3) solution.displacement.push_back({u[n], u[n + 1], u[n + 2]});
  solution.cell_volume = array("volume", mesh.cells.size());
  solution.norms = {mesh_solved.at("root_mean_square").get<double>(),
                    mesh_solved.at("largest").get<double>()};
  solution.unknowns = mesh_solved.at("unknowns").get<std::size_t>();
  solution.newton_iterations = mesh_solved.at("iterations").get<int>();
  solution.residual = mesh_solved.at("residual").get<double>();
  solution.inverted_cells = mesh_solved.at("inverted").get<int>();
  solution.load_reached = 1;
  solution.status = cases::Status::converged;
  return solution;
}

} // namespace

std::optional<std::string> reason_without_getfem(const cases::Scene& scene) {
  const cases::Case& definition = scene.definition;
  if (!cases::has_cells(definition.body)) return "[body] is a network, which has no cells for its elements";
  if (definition.dynamics) return "the case has [dynamics], and its solves are static";
  if (!definition.tools.empty())
    return fmt::format("[[tool]] \"{}\" presses on the body, and its input has no contact",
                       definition.tools.front().name);
  if (!cases::is_isotropic(definition.material))
    return "[material] has a fibre, and its input has isotropic materials";
  if (!scene.masses.empty()) return "the case has [[mass]], and its input has the weight of cells alone";
  if (cases::first_joined(definition))
    return "[[body.removed]] joins a cut, and its input has no joints between nodes";
  for (std::size_t i = 0; i < scene.loads.size(); ++i)
    if (scene.loads[i].load.on() == cases::loads::On::nodes)
      return fmt::format("load[{}] is a force on nodes, and its input has tractions, torques and gravity", i);
  for (std::size_t i = 0; i < scene.moved.size(); ++i)
    if (scene.moved[i].motion.scaled)
      return fmt::format("moved[{}] has scaled_displacement, and its input has no motions that fade out", i);
  return std::nullopt;
}

std::string getfem_scene(const cases::Scene& scene, int most_meshes) {
  ArrayMessage message;
  const bool has_limit = !reason_without_continuum_limit(scene);
  message.header = {{"law", cases::name_of(scene.definition.fem.formulation)},
                    {"mixed", needs_pressure(scene)},
                    {"meshes", has_limit ? most_meshes : 1},
                    {"parts", Json::array()}};
  message.add_mesh(scene.mesh, 1);
  add_laws(message, scene);
  add_constraints(message, scene);
  add_tractions(message, scene);
  return message.text();
}

RefinedMeshes read_getfem_answer(const std::string& text, const cases::Mesh& mesh) try {
  const ReadMessage message = read_array_message(text);
  RefinedMeshes meshes;
  meshes.reason = one_line(message.header.at("reason").get<std::string>());
  for (const Json& solved : message.header.at("meshes")) {
    meshes.refine.push_back(solved.at("refine").get<int>());
    meshes.solutions.push_back(solution_of(message, solved, mesh));
  }
  if (meshes.solutions.empty() && message.header.at("failed").get<bool>())
    throw cases::SolveError("GetFEM: " + meshes.reason);
  return meshes;
} catch (const cases::SolveError&) {
  throw;
} catch (const std::exception& error) {
  throw cases::SolveError(fmt::format("GetFEM's answer is damaged: {}", error.what()));
}

RefinedMeshes solve_with_getfem(const cases::Scene& scene, int most_meshes) {
  if (const auto reason = reason_without_getfem(scene)) return {{}, {}, *reason};
  const ScratchFolder scratch("getfem");
  write_file(scratch.path() / "scene", [&](std::ostream& out) { out << getfem_scene(scene, most_meshes); });
  const auto end =
      call_program({{python, "-I", cases::data_folder("peers") + "/getfem_peer.py", "scene", "answer"},
                    scratch.path(),
                    {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"}});
  if (!end || end->status == no_getfem)
    return {{}, {}, "it is not installed; apt-get install python3-getfem brings it"};
  if (end->status != 0)
    throw cases::SolveError(
        "GetFEM stopped: " +
        one_line(end->said.substr(end->said.size() - std::min<std::size_t>(end->said.size(), 300))));
  return read_getfem_answer(read_file(scratch.path() / "answer"), scene.mesh);
}

} // namespace springproof::compare
