#include "compare/client/scene_message.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "compare/export/lattice_arrays.hpp"
#include "compare/peers/motion.hpp"
#include "compare/solve/springs.hpp"
#include "compare/table/json.hpp"
#include "msm/problem.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

// A scene has mm, N, MPa and t; the message has m, N, Pa and kg.
constexpr double metres = 1e-3, pascals = 1e6, kilograms = 1e3;

void add_mesh(ArrayMessage& message, const cases::Scene& scene) {
  message.add_mesh(scene.mesh, metres);
  NumberArray materials{4};
  const std::vector<cases::Material> all = cases::materials_of(scene.definition);
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c) {
    const cases::LinearElastic linear =
        msm::small_strain_material(all[cases::index(cases::material_of(scene, c))]);
    const cases::CellDynamics dynamics = cases::dynamics_of(scene, c);
    materials.add({linear.youngs_modulus * pascals, linear.poissons_ratio, dynamics.density * 1e12,
                   dynamics.mass_damping});
  }
  message.add("materials", materials);
}

Json history_of(const cases::History& history) {
  return {{"points", history.points}, {"frequency", history.frequency}};
}

void add_loads(ArrayMessage& message, const cases::Scene& scene) {
  Json loads = Json::array(), gravity = Json::array();
  for (const cases::Scene::AppliedLoad& applied : scene.loads) {
    const Json history = history_of(applied.load.history);
    if (applied.load.on() == cases::loads::On::masses) {
      const Eigen::Vector3d g = cases::acceleration_of(applied.load) * metres;
      gravity.push_back({{"acceleration", {g.x(), g.y(), g.z()}}, {"history", history}});
      continue;
    }
    NumberArray forces{4};
    for (const auto& [node, force] : cases::loaded_nodes(scene, {applied}))
      forces.add({double(node), force.x(), force.y(), force.z()});
    const std::string name = "load_" + std::to_string(loads.size());
    loads.push_back({{"forces", name}, {"history", history}});
    message.add(name, forces);
  }
  message.header["loads"] = loads;
  message.header["gravity"] = gravity;
}

/// Constrained components, and where they are at the times of the frames, or at the full load.
void add_supports(ArrayMessage& message, const cases::Scene& scene, const std::vector<double>& times) {
  const bool moves = scene.definition.dynamics.has_value();
  msm::Problem problem = moves ? msm::make_moving_problem(scene) : msm::make_problem(scene);
  NumberArray supports{2}, motion{0};
  for (std::size_t dof = 0; dof < problem.is_constrained.size(); ++dof)
    if (problem.is_constrained[dof]) supports.add({double(dof / 3), double(dof % 3)});
  motion.columns = std::max<std::size_t>(1, supports.values.size() / 2);
  if (problem.supports)
    for (const double at : moves ? times : std::vector<double>{1}) {
      const std::vector<Eigen::Vector3d> all = problem.on_all_points(problem.supports(at));
      for (std::size_t i = 0; i < supports.values.size(); i += 2)
        motion.add({all[std::size_t(supports.values[i])][int(supports.values[i + 1])] * metres});
    }
  message.add("supports", supports);
  message.add("support_motion", motion);
}

/// @return s; the same for all cells
double stiffness_damping(const cases::Scene& scene) {
  const double beta = cases::dynamics_of(scene, 0).stiffness_damping;
  for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
    if (cases::dynamics_of(scene, c).stiffness_damping != beta)
      throw cases::SolveError("clients are told one stiffness_damping, and this case has several");
  return beta;
}

} // namespace

std::string scene_message(const cases::Scene& scene, const ClientBudget& budget) {
  const auto& dynamics = scene.definition.dynamics;
  if (dynamics && dynamics->start != cases::MotionStart::rest)
    throw cases::SolveError("clients start at rest, and this motion starts in equilibrium");
  if (cases::has_memory(scene.definition))
    throw cases::SolveError("clients are told of springs without a memory, and this case has material.prony");
  const std::vector<double> times = frame_times(scene);
  ArrayMessage message;
  message.header = {{"springproof", "scene"},
                    {"protocol", client_protocol},
                    {"case", scene.definition.name},
                    {"units", {{"length", "m"}, {"force", "N"}, {"mass", "kg"}, {"time", "s"}}},
                    {"question", dynamics ? "motion" : "rest"},
                    {"step", dynamics ? dynamics->step : budget.step},
                    {"end", dynamics ? dynamics->end : budget.model_time},
                    {"times", times},
                    {"iterations", budget.iterations > 0 ? Json(budget.iterations) : Json()},
                    {"seconds", budget.seconds},
                    {"masses", cases::name_of(scene.definition.msm.mass)},
                    {"stiffness_damping", stiffness_damping(scene)}};
  if (dynamics)
    message.header["scheme"] = {{"name", cases::name_of(dynamics->scheme.scheme)},
                                {"beta", dynamics->scheme.beta},
                                {"gamma", dynamics->scheme.gamma},
                                {"rho_infinity", dynamics->scheme.rho_infinity}};
  add_mesh(message, scene);
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, springs_as_solved(scene, design_for(scene)));
  for (const NamedArray& one : lattice_arrays(lattice, {metres, 1})) message.add(one.name, one.array);
  NumberArray mass{1}, damping{1};
  for (const double one : cases::point_masses(scene)) mass.add({one * kilograms});
  for (const double one : cases::point_mass_damping(scene)) damping.add({one * kilograms});
  message.add("mass", mass);
  message.add("mass_damping", damping);
  add_loads(message, scene);
  add_supports(message, scene, times);
  return message.text();
}

} // namespace springproof::compare
