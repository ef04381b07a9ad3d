#pragma once

#include "cases/case/steps_by.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <functional>
#include <utility>

/// Bodies without [dynamics] that methods of steps bring to rest.
namespace springproof::mechanics {

/// The scene as a motion that begins with whole loads.
template<class Method>
cases::Scene in_motion(cases::Scene scene, const cases::StepsBy<Method>& real_time) {
  cases::Dynamics& dynamics = scene.definition.dynamics.emplace();
  dynamics.scheme.scheme = cases::Scheme::implicit_euler;
  dynamics.step = real_time.step;
  dynamics.end = real_time.end;
  scene.definition.material_dynamics.mass_damping = real_time.damping;
  for (cases::RegionMaterial& region : scene.definition.region_materials)
    region.dynamics.mass_damping = real_time.damping;
  return scene;
}

/// What steps may take beside what a case says.
struct StepLimits {
  std::function<bool()> should_stop{}; ///< asked after every substep; empty: never
  /// Told of a body that still moves at the end: the answer is its mean. Empty: such a body fails.
  std::function<void(const CameToRest&)> tell_moving{};
};

/// The same as come_to_rest() of follow_motion.hpp, in the steps of a method and within limits.
template<class Method>
CameToRest come_to_rest(const BodyInTime& body, Vector start, const cases::StepsBy<Method>& real_time,
                        IntegrationSettings settings, const StepLimits& limits) {
  settings.newton.should_stop = limits.should_stop;
  CameToRest rest = come_to_rest(body, std::move(start), real_time.step, real_time.end, settings,
                                 limits.tell_moving ? StillMoving::has_mean : StillMoving::fails);
  if (rest.mean_from) limits.tell_moving(rest);
  return rest;
}

/// Says of a solution that it came to rest, if it did, but for its distances from an equilibrium.
/// @param residual  what is left of the loads, relative
inline void add_rest(cases::Solution& solution, const CameToRest& rest, double residual) {
  solution.residual = residual;
  solution.relaxation_iterations = solution.linear_iterations;
  cases::FromEquilibrium& from = solution.from_equilibrium.emplace(
      cases::FromEquilibrium{EquilibriumSettings{}.tolerance, {}, {}, {}, {}, {}});
  if (!rest.mean_from) from.rest = {rest.time, rest.steps};
}

/// Settings of steps that are not halved.
/// @param stable  returns the number of substeps of an explicit method where the case gives none
template<class Method, class Stable>
IntegrationSettings in_substeps(const cases::StepsBy<Method>& real_time, const Stable& stable) {
  IntegrationSettings settings;
  settings.max_halvings = 0;
  settings.substeps = real_time.substeps                     ? *real_time.substeps
                      : cases::is_explicit(real_time.method) ? stable()
                                                             : 1;
  return settings;
}

} // namespace springproof::mechanics
