#pragma once

#include "cases/case/steps_by.hpp"
#include "mechanics/dynamics/follow_motion.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

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
