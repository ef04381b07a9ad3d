#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element_fields.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <utility>

namespace springproof::fem_reference {

/// A scene as finite elements, and their state: the equilibrium last found, or the end of a motion. Every
/// member function is collective.
/// @tparam Body  AssembledBody or grid::GridBody
template<class Body>
struct SolvedBody {
  template<class... Arguments>
  explicit SolvedBody(const cases::Scene& scene, Arguments&&... arguments)
      : body(scene, std::forward<Arguments>(arguments)...), last(body.equations.rest()) {}

  Body body;
  mechanics::Vector last;
  double last_load_factor = 0;             ///< the equilibrium's; 0: at rest
  std::vector<cases::ToolContact> tools{}; ///< what tools do to the body in the equilibrium

  void back_to_rest() {
    last = body.equations.rest();
    last_load_factor = 0;
    if (body.contact()) body.contact()->forget();
  }

  /// See Model::solve_again().
  cases::Solution solve(double load_factor, mechanics::EquilibriumSettings settings) {
    const cases::Case& definition = body.scene.definition;
    settings.from = last_load_factor;
    settings.to = load_factor;
    settings = mechanics::in_small_turns(cases::largest_turn(definition), cases::least_load_steps(definition),
                                         std::move(settings));
    body.add_guess(settings);
    const auto displacement_of = [](const mechanics::Vector& state) -> mechanics::DisplacementAt {
      return [&state](int node) -> Eigen::Vector3d { return state.segment<3>(3 * node); };
    };
    const auto equilibrium = mechanics::find_equilibrium_in_contact(
        body.equations, body.contact(), displacement_of, last, "finite elements", settings);
    last = equilibrium.state;
    last_load_factor = load_factor;
    cases::Solution solution = mechanics::to_solution(equilibrium);
    body.on_mesh().add_to(solution, last);
    solution.tools = tools = body.tools(last, load_factor);
    add_norms(solution);
    if (settings.stability != mechanics::Stability::ignore)
      solution.negative_eigenvalues = body.equations.negative_eigenvalues();
    return solution;
  }

  /// See fem_reference::follow().
  /// @param settings  its Newton settings also find the equilibrium that a motion starts in
  cases::Solution follow(const mechanics::IntegrationSettings& settings) {
    body.set_in_motion(settings.newton);
    last = start_of_motion(settings.newton);
    cases::Solution solution =
        mechanics::follow_motion(body.scene, body.equations, body.on_mesh(), last, settings);
    solution.tools = body.tools(last, body.scene.definition.dynamics->end);
    add_norms(solution);
    return solution;
  }

 private:
  void add_norms(cases::Solution& solution) {
    solution.norms = norms_of(body.elements(last, solution.sharing.get()), solution.sharing.get());
  }

  /// State at the start of the motion: rest, or the static scene's equilibrium on the same nodes and cells.
  mechanics::Vector start_of_motion(const mechanics::EquilibriumSettings& settings) const {
    if (body.scene.definition.dynamics->start == cases::MotionStart::rest) return body.equations.rest();
    SolvedBody still(cases::scene_before_start(body.scene), body);
    still.solve(1, settings);
    return still.last;
  }
};

} // namespace springproof::fem_reference
