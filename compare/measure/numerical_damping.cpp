#include "compare/measure/numerical_damping.hpp"

#include "compare/measure/measure.hpp"

#include <cmath>

namespace springproof::compare {

std::optional<NumericalDamping> numerical_damping(const cases::Measure& measure, const cases::Scene& scene,
                                                  const cases::Solution& solution) {
  const auto& dynamics = scene.definition.dynamics;
  const bool is_damped = dynamics && dynamics->scheme.scheme == cases::Scheme::implicit_euler;
  if (!is_damped || !solution.trajectory || !measure.over_time) return std::nullopt;
  const auto swings = swings_of(series_of(measure, scene, solution));
  if (!swings) return std::nullopt;
  const double omega = 2 * std::acos(-1.0) * swings->frequency;
  return NumericalDamping{swings->frequency,
                          mechanics::swings_in_steps(dynamics->scheme, omega * dynamics->step).damping_ratio,
                          swings->damping_ratio};
}

std::optional<SlowestInSteps> slowest_in_steps(const cases::Scene& scene, const cases::Solution& solution) {
  if (!solution.trajectory || !solution.trajectory->slowest) return std::nullopt;
  const cases::Vibration& slowest = *solution.trajectory->slowest;
  const cases::Dynamics& dynamics = *scene.definition.dynamics;
  return SlowestInSteps{slowest, dynamics.step,
                        mechanics::swings_in_steps(dynamics.scheme, slowest.omega * dynamics.step)};
}

} // namespace springproof::compare
