#include "fem_reference/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/grid/grid_model.hpp"
#include "fem_reference/moving_equations.hpp"
#include "mechanics/equilibrium/turns.hpp"

#include <numeric>
#include <utility>

namespace springproof::fem_reference {

namespace {

/// The state when the motion begins: of the static scene, whose degrees of freedom have the same numbers.
State start_of(const cases::Scene& scene, const AssembledBody& body) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest) return body.equations.rest();
  AssembledBody still(cases::scene_before_start(scene), MPI_COMM_SELF);
  const auto settings =
      mechanics::in_small_turns(cases::largest_turn(still.scene.definition), 1, default_settings());
  return mechanics::find_equilibrium(still.equations, still.equations.rest(), "finite elements", settings)
      .state;
}

cases::Solution follow_assembled(const cases::Scene& scene, const mechanics::IntegrationSettings& settings) {
  AssembledBody body(scene, MPI_COMM_SELF);
  const cases::HexMesh& mesh = body.scene.mesh;
  MovingEquations motion(cases::refine(scene, scene.definition.fem.refine), body.discretisation,
                         body.formulations, body.equations);
  const auto displacement = [&](const State& state) {
    return cases::deal(nullptr, body.displacement(state), mesh.nodes.size(), Eigen::Vector3d(0, 0, 0));
  };
  const auto cell_volumes = [&](const State& state) {
    return cases::deal(nullptr, body.cell_volumes(state), mesh.cells.size(), 0.);
  };
  const auto volume = [&](const State& state) {
    const std::vector<double> of_cells = cell_volumes(state);
    return std::accumulate(of_cells.begin(), of_cells.end(), 0.);
  };
  const mechanics::FollowedMotion followed =
      mechanics::follow_motion(scene, {motion, displacement, volume}, start_of(scene, body), settings);
  cases::Solution solution = mechanics::to_solution(followed.work);
  solution.displacement = displacement(followed.end);
  solution.cell_volume = cell_volumes(followed.end);
  solution.norms = body.norms(followed.end, nullptr);
  solution.inverted_cells = cases::n_inverted(mesh, solution.displacement);
  solution.trajectory = followed.trajectory;
  return solution;
}

} // namespace

mechanics::IntegrationSettings default_steps() {
  mechanics::IntegrationSettings settings;
  settings.newton = default_settings();
  return settings;
}

cases::Solution follow(const cases::Scene& scene, const mechanics::IntegrationSettings& settings,
                       Backend backend) {
  if (backend_of(scene, backend) == Backend::assembled) return follow_assembled(scene, settings);
  grid::GridModel model(scene, MPI_COMM_SELF, 1);
  try {
    cases::Solution solution = model.follow(settings);
    solution.norms = norms_of(model, nullptr);
    return solution;
  } catch (const cases::SolveError&) {
    if (backend == Backend::grid || !model.linear_solver_failed()) throw;
  }
  cases::Solution solution = follow_assembled(scene, settings);
  solution.message = by_assembled_tangent;
  return solution;
}

} // namespace springproof::fem_reference
