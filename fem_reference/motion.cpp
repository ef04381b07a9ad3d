#include "fem_reference/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/grid/grid_model.hpp"
#include "mechanics/equilibrium/turns.hpp"

namespace springproof::fem_reference {

namespace {

/// The state when the motion begins: of the static scene, whose degrees of freedom have the same numbers.
State start_of(const cases::Scene& scene, const AssembledBody& body) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest) return body.equations.rest();
  AssembledBody still(cases::scene_before_start(scene), body.discretisation.communicator);
  const auto settings =
      mechanics::in_small_turns(cases::largest_turn(still.scene.definition), 1, default_settings());
  return mechanics::find_equilibrium(still.equations, still.equations.rest(), "finite elements", settings)
      .state;
}

cases::Solution follow_assembled(const cases::Scene& scene, MPI_Comm communicator,
                                 const mechanics::IntegrationSettings& settings) {
  AssembledBody body(scene, communicator);
  body.equations.set_in_motion(cases::refine(scene, scene.definition.fem.refine), body.formulations);
  State state = start_of(scene, body);
  cases::Solution solution = mechanics::follow_motion(scene, body.equations, body.on_mesh(), state, settings);
  solution.norms = body.norms(state, solution.sharing.get());
  return solution;
}

} // namespace

mechanics::IntegrationSettings default_steps() {
  mechanics::IntegrationSettings settings;
  settings.newton = default_settings();
  return settings;
}

cases::Solution follow(const cases::Scene& scene, const mechanics::IntegrationSettings& settings,
                       Backend backend, MPI_Comm communicator) {
  if (backend_of(scene, backend) == Backend::assembled)
    return follow_assembled(scene, communicator, settings);
  grid::GridModel model(scene, communicator, 1);
  try {
    cases::Solution solution = model.follow(settings);
    solution.norms = norms_of(model, solution.sharing.get());
    return solution;
  } catch (const cases::SolveError&) {
    if (backend == Backend::grid || !model.linear_solver_failed()) throw;
  }
  cases::Solution solution = follow_assembled(scene, communicator, settings);
  solution.message = by_assembled_tangent;
  return solution;
}

} // namespace springproof::fem_reference
