#include "compare/peers/calculix.hpp"

#include "cases/case/elements.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/loads.hpp"
#include "compare/peers/calculix_tool.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solve.hpp"
#include "mechanics/contact/contact.hpp"
#include "msm/lattice.hpp"
#include "msm/problem.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr const char* not_installed = "CalculiX (ccx) is not installed";

/// A number as Fortran prints it. One whose exponent of three digits pushes out the E ("1.234567-101") is 0.
double fortran_number(const std::string& field) {
  return field.find('E') == std::string::npos ? 0 : std::strtod(field.c_str(), nullptr);
}

/// A line of ten columns for the node and fourteen for each component; nothing if it is another line.
std::optional<std::pair<std::size_t, Vector3d>> read_node_line(const std::string& line) {
  if (line.size() < 52) return std::nullopt;
  const std::string node = line.substr(0, 10);
  if (node.find_first_not_of(" 0123456789") != std::string::npos) return std::nullopt;
  Vector3d u;
  for (int a = 0; a < 3; ++a) u[a] = fortran_number(line.substr(10 + 14 * a, 14));
  return std::pair(static_cast<std::size_t>(std::strtoul(node.c_str(), nullptr, 10)), u);
}

/// Newton iterations of all increments, from the .sta file: step, increment, attempt, iterations, ...
int count_iterations(std::istream& in) {
  int total = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    int step, increment, attempt, iterations;
    if (words >> step >> increment >> attempt >> iterations) total += iterations;
  }
  return total;
}

std::string last_error(std::istream& in) {
  std::string error;
  for (std::string line; std::getline(in, line);)
    if (line.find("*ERROR") != std::string::npos) error = line.substr(line.find("*ERROR"));
  return error.empty() ? "it gave no reason" : error;
}

/// What CalculiX leaves of a run.
struct CalculixRun {
  cases::Scene refined; ///< what it solved
  std::vector<CalculixOutput> blocks;
  std::vector<Vector3d> on_tools; ///< forces on the nodes of all tools, one tool after the other, N
  int newton_iterations;          ///< in all increments
  std::string error;              ///< the last that it printed
};

/// Runs CalculiX.  @return nothing when there is no `ccx`   @throws SolveError when it stops
std::optional<CalculixRun> run_calculix(const cases::Scene& scene,
                                        void (*write_input)(std::ostream&, const cases::Scene&)) {
  CalculixRun run{cases::refine(scene, scene.definition.fem.refine), {}, {}, 0, ""};
  const ScratchFolder scratch("ccx");
  write_file(scratch.path() / "case.inp", [&](std::ostream& out) { write_input(out, run.refined); });
  const auto end = call_program(
      {{"ccx", "-i", "case"}, scratch.path(), {"OMP_NUM_THREADS=1", "CCX_NPROC_EQUATION_SOLVER=1"}});
  if (!end) return std::nullopt;
  std::istringstream log(end->said);
  run.error = last_error(log);
  std::ifstream data(scratch.path() / "case.dat"), progress(scratch.path() / "case.sta");
  if (end->status != 0 || !data) throw cases::SolveError("CalculiX stopped: " + run.error);
  run.blocks = read_calculix_blocks(data, run.refined.mesh.nodes.size());
  std::ifstream again(scratch.path() / "case.dat");
  run.on_tools = read_calculix_tool_forces(again, run.refined.mesh.nodes.size());
  run.newton_iterations = count_iterations(progress);
  return run;
}

/// Volumes of the body's cells, each the sum of its descendants, which refinement numbers one after another.
std::vector<double> body_cell_volumes(const cases::Scene& scene, const cases::Scene& refined,
                                      const std::vector<Vector3d>& displacement) {
  const std::size_t n_children = refined.mesh.cells.size() / scene.mesh.cells.size();
  std::vector<double> volumes(scene.mesh.cells.size(), 0.0);
  for (std::size_t c = 0; c < refined.mesh.cells.size(); ++c)
    volumes[c / n_children] += cases::cell_volume(cases::cell_corners(refined.mesh, c, displacement));
  return volumes;
}

/// Largest difference of two displacements over the largest displacement of the first; NaN if a number is.
double largest_difference(const cases::Solution& a, const cases::Solution& b) {
  using Field = Eigen::Map<const Eigen::Matrix3Xd>;
  const Field u(a.displacement[0].data(), 3, Eigen::Index(a.displacement.size()));
  const Field v(b.displacement[0].data(), 3, Eigen::Index(b.displacement.size()));
  const auto largest = [](const auto& field) {
    return field.colwise().norm().template maxCoeff<Eigen::PropagateNaN>();
  };
  return largest(u - v) / largest(u);
}

/// Whether CalculiX has an element: C3D8, C3D4 and C3D10.
bool has_element(cases::Element element) {
  return element == cases::Element::q1 || element == cases::Element::p1 || element == cases::Element::p2;
}

bool measures_volume(const cases::Case& definition) {
  return std::any_of(
      definition.measures.begin(), definition.measures.end(),
      [](const cases::Measure& measure) { return cases::is<cases::measures::Volume>(measure); });
}

/// Why CalculiX cannot follow a dynamic case.
std::optional<std::string> reason_without_calculix_motion(const cases::Case& definition) {
  if (!std::holds_alternative<cases::LinearElastic>(definition.material) ||
      !definition.region_materials.empty())
    return "its input has one linear elastic material";
  if (!definition.masses.empty()) return "its input has no weights";
  if (!has_element(definition.fem.element) || definition.fem.mass != cases::ElementMass::consistent)
    return "it has the elements q1, p1 and p2, with consistent masses";
  const cases::TimeScheme& scheme = definition.dynamics->scheme;
  if (scheme.scheme != cases::Scheme::newmark || scheme.beta != 0.25 || scheme.gamma != 0.5)
    return "its scheme is newmark with beta = 1/4 and gamma = 1/2";
  if (definition.fem.formulation != cases::Formulation::small_strain) return "its motion is linear";
  if (definition.dynamics->start != cases::MotionStart::rest) return "its motion begins at rest";
  if (cases::has_memory(definition)) return "its input has no Prony series";
  if (definition.material_dynamics.mass_damping > 0 || definition.material_dynamics.stiffness_damping > 0)
    return "its implicit steps have no damping";
  for (const cases::Load& load : definition.loads)
    if (load.on() == cases::loads::On::masses || load.history.frequency != 0)
      return "its loads have histories in points, and none is gravity";
  if (measures_volume(definition)) return "volumes over time are not read";
  return std::nullopt;
}

/// Why CalculiX cannot have a case's tools.
std::optional<std::string> reason_without_contact(const cases::Case& definition) {
  if (definition.tools.empty()) return std::nullopt;
  if (definition.dynamics)
    return fmt::format("[[tool]] \"{}\" moves in time, and its contact is at rest",
                       definition.tools.front().name);
  for (const cases::Tool& tool : definition.tools) {
    if (tool.friction > 0)
      return fmt::format("[[tool]] \"{}\" has friction, and its input has none", tool.name);
    if (std::holds_alternative<cases::tools::Surface>(tool.shape))
      return fmt::format("[[tool]] \"{}\" is a surface of a file, which its input has no cells for",
                         tool.name);
  }
  if (cases::facts_of(definition.fem.element).degree > 1)
    return fmt::format("its contact of nodes with tools is for elements q1 and p1, not {}",
                       cases::name_of(definition.fem.element));
  return std::nullopt;
}

} // namespace

std::optional<std::string> reason_without_calculix(const cases::Case& definition) {
  if (!definition.moved.empty()) return "its input has no moved regions";
  if (const auto reason = reason_without_contact(definition)) return reason;
  if (definition.dynamics) return reason_without_calculix_motion(definition);
  if (std::any_of(definition.loads.begin(), definition.loads.end(),
                  [](const cases::Load& load) { return load.on() == cases::loads::On::masses; }))
    return "its input has no gravity";
  if (!definition.region_materials.empty()) return "its input has one material";
  if (std::holds_alternative<cases::TransverselyIsotropic>(definition.material))
    return "its input has isotropic materials";
  const cases::Fem& fem = definition.fem;
  const bool has_formulation = fem.formulation == cases::Formulation::small_strain ||
                               fem.formulation == cases::Formulation::saint_venant_kirchhoff;
  if (fem.element == cases::Element::p2 && measures_volume(definition))
    return "volumes of quadratic cells are not read";
  if (has_formulation && has_element(fem.element)) return std::nullopt;
  return fmt::format(
      "CalculiX has small_strain and saint_venant_kirchhoff with elements q1, p1 and p2, not {} with {}",
      cases::name_of(fem.formulation), cases::name_of(fem.element));
}

std::vector<CalculixOutput> motion_by_calculix(const cases::Scene& scene) {
  auto run = run_calculix(scene, write_calculix_motion_input);
  if (!run) return {};
  const auto n_steps = static_cast<std::size_t>(scene.definition.dynamics->n_steps());
  if (run->blocks.size() != n_steps)
    throw cases::SolveError(fmt::format("CalculiX printed {} steps of {}", run->blocks.size(), n_steps));
  for (CalculixOutput& step : run->blocks) step.displacement.resize(scene.mesh.nodes.size());
  return std::move(run->blocks);
}

std::vector<CalculixOutput> read_calculix_blocks(std::istream& in, std::size_t n_nodes) {
  std::vector<CalculixOutput> blocks;
  std::vector<bool> seen; // empty before the first block
  const auto check_last = [&] {
    if (std::find(seen.begin(), seen.end(), false) != seen.end())
      throw cases::SolveError("CalculiX printed no displacement for some node");
  };
  for (std::string line; std::getline(in, line);) {
    if (line.find("displacements") != std::string::npos) {
      check_last();
      CalculixOutput& block = blocks.emplace_back();
      block.displacement.assign(n_nodes, Vector3d::Zero());
      seen.assign(n_nodes, false);
      const std::size_t time = line.find("time");
      if (time != std::string::npos) block.load_reached = std::strtod(line.c_str() + time + 4, nullptr);
      continue;
    }
    const auto entry = seen.empty() ? std::nullopt : read_node_line(line);
    if (!entry || entry->first < 1 || entry->first > n_nodes) continue;
    blocks.back().displacement[entry->first - 1] = entry->second;
    seen[entry->first - 1] = true;
  }
  check_last();
  if (blocks.empty()) throw cases::SolveError("CalculiX printed no displacement for some node");
  return blocks;
}

std::vector<Vector3d> read_calculix_tool_forces(std::istream& in, std::size_t n_nodes) {
  std::vector<Vector3d> forces;
  bool is_of_forces = false;
  for (std::string line; std::getline(in, line);) {
    if (line.find(" for set ") != std::string::npos) is_of_forces = line.find("forces") != std::string::npos;
    const auto entry = is_of_forces ? read_node_line(line) : std::nullopt;
    if (!entry || entry->first <= n_nodes) continue;
    const std::size_t at = entry->first - n_nodes - 1;
    if (forces.size() <= at) forces.resize(at + 1, Vector3d::Zero());
    forces[at] = entry->second / calculix_force_unit;
  }
  return forces;
}

namespace {

/// What tools do to the body: forces and torques as CalculiX has them on the tools' nodes, areas and depths
/// by our own shapes where its body is.
std::vector<cases::ToolContact> tools_of(const CalculixRun& run, const std::vector<Vector3d>& displacement) {
  if (run.refined.definition.tools.empty()) return {};
  const mechanics::Contact contact(mechanics::tool_sides(run.refined));
  auto found = contact.found([&](int node) { return displacement[cases::index(node)]; }, 1);
  std::size_t first = 0;
  for (std::size_t t = 0; t < found.size(); ++t) {
    const cases::Tool& tool = run.refined.definition.tools[t];
    const ToolMesh mesh = mesh_of_tool(run.refined, tool);
    cases::ToolContact& here = found[t];
    here.force = here.torque = Vector3d::Zero();
    here.nodes.clear();
    here.on_nodes.clear();
    for (std::size_t n = 0; n < mesh.nodes.size() && first + n < run.on_tools.size(); ++n) {
      const Vector3d& force = run.on_tools[first + n];
      here.force += force;
      here.torque += (mesh.nodes[n] - tool.place(0)).cross(force);
    }
    first += mesh.nodes.size();
  }
  return found;
}

cases::Solution follow_with_calculix(const cases::Scene& scene) {
  cases::Solution solution;
  const std::vector<CalculixOutput> steps = motion_by_calculix(scene);
  if (steps.empty()) {
    solution.message = not_installed;
    return solution; // skipped
  }
  const cases::Dynamics& dynamics = *scene.definition.dynamics;
  cases::Trajectory& trajectory = solution.trajectory.emplace();
  trajectory.nodes = cases::watched_nodes(scene);
  const auto add = [&](int step, const std::vector<Vector3d>& displacement) {
    trajectory.time.push_back(step * dynamics.step);
    for (const int node : trajectory.nodes)
      trajectory.displacement.push_back(displacement[cases::index(node)]);
    if (step % dynamics.write_every == 0 || step == dynamics.n_steps())
      trajectory.bodies.push_back({step, displacement});
  };
  add(0, std::vector<Vector3d>(scene.mesh.nodes.size(), Vector3d::Zero()));
  for (std::size_t n = 0; n < steps.size(); ++n) add(static_cast<int>(n) + 1, steps[n].displacement);
  solution.displacement = steps.back().displacement;
  solution.status = cases::Status::converged;
  solution.load_reached = 1;
  msm::measure_cells(scene.mesh, solution);
  return solution;
}

} // namespace

cases::Solution solve_with_calculix(const cases::Scene& scene) {
  cases::Solution solution;
  solution.message = reason_without_calculix(scene.definition).value_or("");
  if (!solution.message.empty()) return solution; // skipped
  if (scene.definition.dynamics) return follow_with_calculix(scene);
  const auto run = run_calculix(scene, write_calculix_input);
  if (!run) {
    solution.message = not_installed;
    return solution; // skipped
  }
  const CalculixOutput& output = run->blocks.back();
  solution.load_reached = output.load_reached;
  solution.newton_iterations = run->newton_iterations;
  const std::vector<bool> fixed = cases::constrained_dofs(
      cases::refine(run->refined, cases::facts_of(scene.definition.fem.element).degree - 1));
  solution.unknowns = static_cast<std::size_t>(std::count(fixed.begin(), fixed.end(), false));
  if (!(output.load_reached > 1 - 1e-6)) // its time is printed with seven digits
    throw cases::SolveError("CalculiX stopped: " + run->error, solution);

  solution.status = cases::Status::converged;
  solution.load_reached = 1;
  // Refinement keeps the numbers of the body's own nodes.
  solution.displacement = output.displacement;
  solution.tools = tools_of(*run, output.displacement);
  solution.displacement.resize(scene.mesh.nodes.size());
  msm::measure_cells(scene.mesh, solution);
  solution.cell_volume = body_cell_volumes(scene, run->refined, output.displacement);
  return solution;
}

Peer ask_calculix(const cases::Scene& scene, const Answer& fem) {
  const cases::Solution ours = gathered(fem.solution);
  Peer peer{"CalculiX", {}, std::nullopt};
  peer.answer = shared_from_rank_0<Answer>(scene.mesh, [&] {
    Answer answer;
    Stopwatch stopwatch;
    try {
      answer.solution = solve_with_calculix(scene);
    } catch (
        const std::runtime_error& error) { // a solve that failed, a folder that cannot be made or written
      answer.solution = failed_solution(error);
    }
    answer.solve_seconds = stopwatch.lap();
    if (answer.converged() && fem.converged())
      peer.largest_difference = largest_difference(ours, answer.solution);
    return answer;
  });
  return peer;
}

} // namespace springproof::compare
