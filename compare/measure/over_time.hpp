#pragma once

#include "cases/case/dynamics.hpp"

#include <optional>
#include <string>
#include <vector>

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

/// A number of a series, in the unit of unit_over_time().
/// @param series  of at least one value
/// @return finite; nothing where why_without_number() has a reason
std::optional<double> value_over_time(cases::OverTime what, const TimeSeries& series);

/// Why a series has no such number: frequencies of what does not swing, an overshoot of what settles where it
/// began, the time of a peak of what does not move, anything of values that are not finite. Empty: it has
/// one.
std::string why_without_number(cases::OverTime what, const TimeSeries& series);

/// Root mean square of the difference of two series of equal times over that of the reference, percent;
/// nothing when error_percent() has none (the reference is zero but for rounding, or next to the difference),
/// or a value is not finite.
std::optional<double> trajectory_error_percent(const TimeSeries& reference, const TimeSeries& other);

/// Whether it has another unit than the measure: a time, a frequency, a ratio.
bool has_own_unit(cases::OverTime what);

/// Its unit, of a measure that has one.  @param unit  of the measure's values
std::string unit_over_time(cases::OverTime what, const std::string& unit);

} // namespace springproof::compare
