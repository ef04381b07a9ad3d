#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/measure/measure.hpp"
#include "compare/peers/motion.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/springs.hpp"
#include "msm/problem.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

/// The content of a file whose ending and name were looked at, and whether it is a .csv.
std::pair<std::string, bool> read_result_file(const std::string& path) {
  static const std::vector<std::string> endings{".csv", ".vtu", ".vtp", ".vtk", ".vts", ".vtr", ".vti"};
  const std::string ending = std::filesystem::path(path).extension();
  if (std::find(endings.begin(), endings.end(), ending) == endings.end())
    throw cases::InputError(fmt::format("{}: displacements must be in a file {} (x,y,z,ux,uy,uz), or of VTK: "
                                        "{}; a motion (.pvd, a folder) is of a case with [dynamics]",
                                        path, endings.front(),
                                        fmt::join(endings.begin() + 1, endings.end(), " ")));
  if (one_line(path) != path)
    throw cases::InputError(one_line(path) + ": the file's name must be one line of UTF-8 text");
  const bool is_csv = ending == ".csv";
  return {is_csv ? cases::read_text_file(path) : cases::read_bytes(path), is_csv};
}

cases::Solution solution_at(std::vector<Vector3d> displacement) {
  cases::Solution solution;
  solution.displacement = std::move(displacement);
  return solution;
}

cases::CellCloud cells_of(const std::string& text, const cases::Mesh& mesh, const std::string& path) try {
  return cases::read_cell_cloud(text, mesh);
} catch (const std::runtime_error& error) {
  throw cases::InputError(fmt::format("{}: cannot be interpolated: {}", path, error.what()));
}

ExternalDisplacements read_interpolated(const cases::Mesh& mesh, const std::string& path,
                                        const std::string& array) {
  const auto [text, is_csv] = read_result_file(path);
  if (is_csv)
    throw cases::InputError(path + ": --interpolate needs the results' cells, which a .csv does not have");
  cases::CellCloud cells = cells_of(text, mesh, path);
  std::vector<Vector3d> displacement = cells.to_nodes.of(finite_displacements(cells.cloud, path, array));
  for (std::size_t n = 0; n < displacement.size(); ++n)
    if (!displacement[n].allFinite())
      throw cases::InputError(fmt::format("{}: cannot be interpolated: is not finite at node {}", path, n));
  return {path, solution_at(std::move(displacement)), std::move(cells)};
}

/// What another program found of all nodes of the mesh as an answer, shared by the ranks.
Answer answer_of(const cases::Mesh& mesh, const std::function<cases::Solution()>& found) {
  return shared_from_rank_0<Answer>(mesh, [&] {
    Answer answer;
    cases::Solution& solution = answer.solution;
    solution = found();
    solution.status = cases::Status::converged;
    solution.load_reached = 1;
    msm::measure_cells(mesh, solution);
    return answer;
  });
}

/// Takes the finite elements' displacement there and back, by which the results' loss is estimated.
Interpolated interpolated(const Answer& fem, const cases::Mesh& mesh, const cases::CellCloud& cells) {
  Interpolated result;
  result.n_points = cells.cloud.points.size();
  const double at_the_surface = same_place(mesh);
  for (const double distance : cells.to_nodes.outside) {
    if (distance <= at_the_surface) continue;
    ++result.n_outside;
    result.largest_distance = std::max(result.largest_distance, distance);
  }
  if (!fem.converged()) return result;
  const cases::Solution whole = gathered(fem.solution);
  result.fem_and_back = answer_of(
      mesh, [&] { return solution_at(cells.to_nodes.of(cells.from_nodes.of(whole.displacement))); });
  return result;
}

constexpr double told_support = 0.01; ///< part of the largest displacement
constexpr double told_work = 0.5;

/// What is held elsewhere than the case holds it; empty: nothing.
std::string moved_supports(const cases::Mesh& mesh, const msm::Problem& problem,
                           const std::vector<Vector3d>& displacement) {
  const msm::Points held = problem.supports ? problem.on_all_points(problem.supports(1))
                                            : msm::Points(displacement.size(), Vector3d::Zero());
  const auto largest = [&](const std::vector<Vector3d>& field) {
    return field_norm(cases::measures::DisplacementFieldMax{}, mesh, field);
  };
  const double told = told_support * std::max(largest(displacement), largest(held));
  std::size_t n_held = 0, n_moved = 0, worst_node = 0;
  int worst_axis = 0;
  double worst = 0;
  for (std::size_t n = 0; n < displacement.size(); ++n)
    for (int a = 0; a < 3; ++a) {
      if (!problem.is_constrained[3 * n + static_cast<std::size_t>(a)]) continue;
      ++n_held;
      const double off = std::abs(displacement[n][a] - held[n][a]);
      if (off > told) ++n_moved;
      if (off <= worst) continue;
      worst = off;
      worst_node = n;
      worst_axis = a;
    }
  if (n_moved == 0) return "";
  const Vector3d at = mesh.nodes[worst_node];
  return fmt::format(
      "{} of {} held displacements are not as the case holds them: node {} at ({:g}, {:g}, {:g}) moves by "
      "{:.3g} mm along {}, must move by {:g}; are these displacements of this case, in its axes and in mm?",
      n_moved, n_held, worst_node, at.x(), at.y(), at.z(), displacement[worst_node][worst_axis],
      "xyz"[worst_axis], held[worst_node][worst_axis]);
}

/// Adds what the case's springs say.
void hold_against_springs(const cases::Scene& scene, const msm::Problem& problem,
                          const std::vector<Vector3d>& displacement, HeldAgainstCase& found) {
  check_memory(scene.definition.file, estimate(size_of(scene), {cases::Side::msm}), memory_limit());
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, springs_as_solved(scene, design_for(scene)));
  const msm::Points force = msm::internal_force_at(lattice, displacement); // minus the gradient
  const msm::Points load = problem.on_all_points(problem.force);
  double residual = 0, applied = 0, held = 0, work = 0, work_of_loads = 0, work_of_springs = 0;
  for (std::size_t n = 0; n < displacement.size(); ++n)
    for (int a = 0; a < 3; ++a) {
      const double u = displacement[n][a], gradient = -force[n][a];
      work_of_springs += gradient * u;
      if (problem.is_constrained[3 * n + static_cast<std::size_t>(a)]) {
        held += gradient * gradient;
        continue;
      }
      const double left = gradient - load[n][a];
      residual += left * left;
      applied += load[n][a] * load[n][a];
      work += left * u;
      work_of_loads += load[n][a] * u;
    }
  const double scale = applied > 0 ? applied : held,
               whole = std::max(std::abs(work_of_loads), std::abs(work_of_springs));
  if (!(scale > 0) || !(whole > 0)) return;
  const double relative = std::sqrt(residual / scale), of_work = std::abs(work) / whole;
  const std::string design = cases::name_of(scene.definition.msm.design);
  found.message = fmt::format("held against the case's own springs ({}): residual {:.2e} of its {}, {:.2g} % "
                              "of the work unbalanced",
                              design, relative, applied > 0 ? "loads" : "reactions", 100 * of_work);
  if (!(of_work <= told_work))
    found.warnings.push_back(fmt::format(
        "no body that is about as stiff as the case's springs ({}) answers so: {:.3g} % of the work is "
        "unbalanced; are these displacements under the case's loads, in its axes and in mm?",
        design, 100 * of_work));
}

} // namespace

void refuse_array(const std::string& path) {
  throw cases::InputError(path + ": --array chooses among the arrays of a VTK file, and a .csv has none");
}

std::vector<GivenDisplacement> read_displacements(const std::string& path, const std::string& array) {
  const auto [text, is_csv] = read_result_file(path);
  if (is_csv && !array.empty()) refuse_array(path);
  return is_csv ? read_displacement_csv(text, path) : read_displacement_vtk(text, path, array);
}

void check_displacements_suffice(const cases::Case& definition, const std::string& option) {
  for (const cases::Measure& measure : definition.measures)
    if (cases::is_of_fields(measure.kind))
      throw cases::InputError(
          measure.where,
          fmt::format("kind is \"{}\", which displacements alone do not tell: leave it out beside {}",
                      cases::name_of(measure.kind), option));
}

std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path, Transfer transfer,
                                                   const std::string& array) {
  if (path.empty()) return std::nullopt;
  if (questions.size() != 1)
    throw cases::InputError(
        fmt::format("--msm-displacements: belongs to one case, {} are given", questions.size()));
  cases::refuse_network(questions.front().scene.definition, "--msm-displacements",
                        "give the body as a mesh of cells, in whose nodes they are");
  cases::refuse_tools(questions.front().scene.definition, "--msm-displacements",
                      "displacements alone do not tell what a tool does");
  check_displacements_suffice(questions.front().scene.definition, "--msm-displacements");
  const cases::Scene& scene = questions.front().scene;
  if (scene.definition.dynamics) {
    if (transfer == Transfer::interpolated)
      throw cases::InputError(
          "--interpolate: takes displacements at rest, and this case has [dynamics]: write "
          "the motion at the nodes of the case's mesh");
    if (n_mpi_ranks() > 1)
      throw cases::InputError("--msm-displacements: a motion is read on one rank; start without mpirun");
    return ExternalDisplacements{path, motion_from(scene, path, array)};
  }
  if (transfer == Transfer::interpolated) return read_interpolated(scene.mesh, path, array);
  return ExternalDisplacements{path,
                               solution_at(match_nodes(scene.mesh, read_displacements(path, array), path))};
}

HeldAgainstCase hold_against_case(const cases::Scene& scene, const std::vector<Vector3d>& displacement) {
  HeldAgainstCase found;
  const bool moves = scene.definition.dynamics.has_value();
  const msm::Problem problem = msm::make_problem(moves ? cases::scene_at_end(scene) : scene);
  const std::string supports = moved_supports(scene.mesh, problem, displacement);
  if (!supports.empty()) found.warnings.push_back(supports);
  if (moves) return found; // springs do not tell a motion's inertia
  try {
    hold_against_springs(scene, problem, displacement, found);
  } catch (const cases::InputError&) { // the case has no springs that could say anything
  } catch (const cases::SolveError&) {
  }
  return found;
}

Answers with_displacements(Answers answers, const cases::Scene& scene,
                           const ExternalDisplacements& external) {
  const cases::Mesh& mesh = scene.mesh;
  HeldAgainstCase held = hold_against_case(scene, external.solution.displacement);
  answers.msm = answer_of(mesh, [&] { return external.solution; });
  answers.msm.solution.message = held.message;
  answers.msm_warnings = std::move(held.warnings);
  answers.design.reset();
  answers.msm_source = external.path;
  answers.msm_name = std::filesystem::path(external.path).filename().string();
  if (external.cells) answers.interpolated = interpolated(answers.fem, mesh, *external.cells);
  return answers;
}

} // namespace springproof::compare
