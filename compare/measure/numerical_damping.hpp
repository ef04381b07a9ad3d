#pragma once

#include "compare/measure/over_time.hpp"
#include "compare/solve/answers.hpp"
#include "mechanics/dynamics/scheme.hpp"

/// What the steps of a motion add to the damping of the body.
namespace springproof::compare {

/// What the implicit Euler method adds to the damping of a measure that swings.
struct NumericalDamping {
  double frequency; ///< Hz, of the swings of the measure
  double ratio;     ///< damping ratio that the step gives them
  double measured;  ///< of the swings as they are: the body's damping and the step's
  bool exceeds_body() const { return ratio > measured - ratio; }
};
/// @return nothing for another scheme, and for a measure that does not swing
std::optional<NumericalDamping> numerical_damping(const cases::Measure& measure, const cases::Scene& scene,
                                                  const cases::Solution& solution);

/// What the steps of any scheme make of the body's slowest vibration, whether a measure shows it or not: all
/// others are resolved worse.
struct SlowestInSteps {
  cases::Vibration vibration;
  double step; ///< s
  mechanics::SwingsInSteps swings;

  double omega_h() const { return vibration.omega * step; }
  bool outlasts_period() const { return omega_h() > 2 * 3.14159265358979; }
  /// A damping ratio of 0.001 takes 0.6 % of a swing.
  bool exceeds_body() const { return swings.damping_ratio > std::max(vibration.damping_ratio, 1e-3); }
  bool is_late() const { return swings.period > 1.02; }
};
/// @return nothing where no slowest vibration is known
std::optional<SlowestInSteps> slowest_in_steps(const cases::Scene& scene, const cases::Solution& solution);

} // namespace springproof::compare
