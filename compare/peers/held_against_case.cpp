#include "compare/peers/held_against_case.hpp"

#include "cases/case/names.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/springs.hpp"
#include "msm/problem.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

constexpr double told_support = 0.01; ///< of the largest displacement
constexpr double told_work = 0.5;

double largest(const std::vector<Vector3d>& vectors) {
  double found = 0;
  for (const Vector3d& vector : vectors) found = std::max(found, vector.norm());
  return found;
}

/// What is held elsewhere than the case holds it; empty: nothing.
std::string moved_supports(const cases::HexMesh& mesh, const msm::Problem& problem,
                           const std::vector<Vector3d>& displacement) {
  const msm::Points held = problem.supports ? problem.on_all_points(problem.supports(1))
                                            : msm::Points(displacement.size(), Vector3d::Zero());
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

HeldAgainstCase hold_against_case(const cases::Scene& scene, const std::vector<Vector3d>& displacement) {
  HeldAgainstCase found;
  const msm::Problem problem = msm::make_problem(scene);
  const std::string supports = moved_supports(scene.mesh, problem, displacement);
  if (!supports.empty()) found.warnings.push_back(supports);
  try {
    hold_against_springs(scene, problem, displacement, found);
  } catch (const cases::InputError&) { // the case has no springs that could say anything
  } catch (const cases::SolveError&) {
  }
  return found;
}

} // namespace springproof::compare
