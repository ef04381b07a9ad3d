#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/scheme.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <variant>
#include <vector>

/// Numbers of a measure's course over time, and what the steps add to its damping.
namespace springproof::compare {

/// A measure over time.
struct TimeSeries {
  std::vector<double> time;  ///< s, ascending
  std::vector<double> value; ///< as many, in the measure's unit
  double zero = 0;           ///< up to which size a value, or a change of it, is zero but for rounding
};

/// A turning point of a series: a maximum or a minimum, of the parabola through three values.
struct Extreme {
  double time, value;
};

/// The turning points between the ends of a series, which maxima and minima take turns in. What goes back by
/// no more than 5 % of the whole range, or by no more than the series' zero, is noise.
std::vector<Extreme> extremes(const TimeSeries& series);

/// A decaying oscillation about a value.
struct Swings {
  double frequency;     ///< Hz, of the damped oscillation
  double damping_ratio; ///< zeta; of an oscillation that grows below 0
  double settled;       ///< the value that it is about
};

/// Fit to all extremes: half periods by a straight line through their times, decay by one through the
/// logarithms of the ways between them, which do not depend on where the swings settle (logarithmic
/// decrement).
/// @return nothing with fewer than three extremes, with values that are not finite, and of swings that take
/// fewer than four steps each: a parabola through three values shows no extreme of these, and noise has them
std::optional<Swings> swings_of(const TimeSeries& series);

/// A number of a series, finite and in the unit of unit_over_time(), or why it has none: frequencies of what
/// does not swing, an overshoot of what settles where it began, the time of a peak of what does not move,
/// anything of values that are not finite.
/// @param series  has at least one value
std::variant<double, std::string> number_over_time(cases::OverTime what, const TimeSeries& series);

/// The same; nothing without a number.
std::optional<double> value_over_time(cases::OverTime what, const TimeSeries& series);

/// Root mean square of the difference of two series of equal times over that of the reference, percent;
/// nothing when error_percent() has none (the reference is zero but for rounding, or next to the difference),
/// or a value is not finite.
std::optional<double> trajectory_error_percent(const TimeSeries& reference, const TimeSeries& other);

/// Its unit: that of the measure's values, or a time's, a frequency's, a ratio's.
/// @param unit  unit of the measure's values
std::string unit_over_time(cases::OverTime what, const std::string& unit);

/// What the implicit Euler method adds to the damping of a measure that swings.
struct NumericalDamping {
  double frequency; ///< Hz, of the swings of the measure
  double ratio;     ///< damping ratio that the step gives them
  double measured;  ///< damping ratio of the swings as they are: the body's and the step's
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
  bool outlasts_period() const { return omega_h() > 2 * M_PI; }
  /// A damping ratio of 0.001 takes 0.6 % of a swing.
  bool exceeds_body() const { return swings.damping_ratio > std::max(vibration.damping_ratio, 1e-3); }
  bool is_late() const { return swings.period > 1.02; }
};
/// @return nothing where no slowest vibration is known
std::optional<SlowestInSteps> slowest_in_steps(const cases::Scene& scene, const cases::Solution& solution);

} // namespace springproof::compare
