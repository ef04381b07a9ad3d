#include "compare/measure/over_time.hpp"

#include "compare/measure/measure.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string>

namespace springproof::compare {

namespace {

/// The vertex of the parabola through the values at i - 1, i, i + 1.
Extreme vertex(const TimeSeries& series, std::size_t i) {
  const double t = series.time[i], value = series.value[i];
  const double before = series.time[i - 1] - t, after = series.time[i + 1] - t;
  const double slope_before = (series.value[i - 1] - value) / before,
               slope_after = (series.value[i + 1] - value) / after;
  const double curvature =
      (slope_after - slope_before) / (after - before); // parabola: curvature s² + slope s + value
  const double slope = slope_before - curvature * before;
  if (curvature == 0) return {t, value};
  const double at = std::clamp(-slope / (2 * curvature), before, after);
  return {t + at, value + (slope + curvature * at) * at};
}

/// Slope of the straight line, by least squares, through values at 0, 1, 2, ...; at least two.
double slope_of(const std::vector<double>& values) {
  double moment = 0, inertia = 0;
  const double centre = (static_cast<double>(values.size()) - 1) / 2;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double arm = static_cast<double>(i) - centre;
    moment += arm * values[i];
    inertia += arm * arm;
  }
  return moment / inertia;
}

double root_mean_square(const std::vector<double>& time, const std::vector<double>& value) {
  if (time.size() < 2) return value.empty() ? 0 : std::abs(value.front());
  double integral = 0; // by trapezoids
  for (std::size_t i = 1; i < time.size(); ++i)
    integral += (time[i] - time[i - 1]) * (value[i] * value[i] + value[i - 1] * value[i - 1]) / 2;
  return std::sqrt(integral / (time.back() - time.front()));
}

std::size_t furthest(const TimeSeries& series) {
  const auto is_nearer = [&](double a, double b) {
    return std::abs(a - series.value.front()) < std::abs(b - series.value.front());
  };
  const auto at = std::max_element(series.value.begin(), series.value.end(), is_nearer);
  return static_cast<std::size_t>(at - series.value.begin());
}

/// Finds the peak, between two steps too unless it is at an end.
Extreme peak_of(const TimeSeries& series) {
  const std::size_t i = furthest(series);
  if (i == 0 || i + 1 == series.value.size()) return {series.time[i], series.value[i]};
  return vertex(series, i);
}

/// Longest way that is rounding: 1e-9 of the longest of all, as a solve leaves 1e-9 of its forces.
double rounding_of(const TimeSeries& series) {
  return std::max(series.zero, 1e-9 * std::abs(series.value[furthest(series)] - series.value.front()));
}

bool are_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

double settled_value(const TimeSeries& series) {
  const auto swings = swings_of(series);
  return swings ? swings->settled : series.value.back();
}

} // namespace

std::vector<Extreme> extremes(const TimeSeries& series) {
  std::vector<Extreme> found;
  if (series.value.size() < 3) return found;
  const auto [lowest, highest] = std::minmax_element(series.value.begin(), series.value.end());
  const double noise = std::max(0.05 * (*highest - *lowest), series.zero);
  if (!(noise > 0)) return found;
  // The candidates since the last turning point, and which way the series goes: 0 until it has gone anywhere.
  std::size_t low = 0, high = 0;
  int direction = 0;
  for (std::size_t i = 1; i < series.value.size(); ++i) {
    if (series.value[i] < series.value[low]) low = i;
    if (series.value[i] > series.value[high]) high = i;
    const bool fell = direction >= 0 && series.value[high] - series.value[i] > noise;
    const bool rose = direction <= 0 && series.value[i] - series.value[low] > noise;
    if (!fell && !rose) continue;
    const std::size_t turned = fell ? high : low;
    const bool is_start = direction == 0 && std::abs(series.value[turned] - series.value[0]) <= noise;
    if (!is_start) found.push_back(vertex(series, turned));
    direction = fell ? -1 : 1;
    low = high = i;
  }
  return found;
}

std::optional<Swings> swings_of(const TimeSeries& series) {
  if (!are_finite(series.value)) return std::nullopt;
  const std::vector<Extreme> all = extremes(series);
  if (all.size() < 3) return std::nullopt;
  std::vector<double> times, ways;
  for (std::size_t k = 0; k < all.size(); ++k) {
    times.push_back(all[k].time);
    if (k > 0) ways.push_back(std::log(std::abs(all[k].value - all[k - 1].value)));
  }
  const double half_period = slope_of(times);
  const double step =
      (series.time.back() - series.time.front()) / static_cast<double>(series.time.size() - 1);
  if (half_period < 2 * step) return std::nullopt;
  const double decrement = -slope_of(ways); // decay in half a swing: pi zeta / sqrt(1 - zeta²)
  const double ratio = decrement / M_PI;
  const double left = std::exp(-decrement); // size ratio of successive extremes, on opposite sides
  const double last = all.back().value, before = all[all.size() - 2].value;
  return Swings{0.5 / half_period, ratio / std::hypot(1, ratio), (last + left * before) / (1 + left)};
}

std::variant<double, std::string> number_over_time(cases::OverTime what, const TimeSeries& series) {
  using cases::OverTime;
  assert(!series.value.empty() && series.value.size() == series.time.size());
  if (what == OverTime::end ? !std::isfinite(series.value.back()) : !are_finite(series.value))
    return "a value of its course is not a finite number";
  const auto is_way = [&](double to) { return std::abs(to - series.value.front()) > rounding_of(series); };
  switch (what) {
  case OverTime::end:
    break;
  case OverTime::settled:
    return settled_value(series);
  case OverTime::peak:
    return peak_of(series).value;
  case OverTime::peak_time:
    if (!is_way(peak_of(series).value)) return "it does not move";
    return peak_of(series).time;
  case OverTime::overshoot: {
    const double settled = settled_value(series);
    if (!is_way(settled)) return "it settles where it began";
    return 100 * (peak_of(series).value - settled) / (settled - series.value.front());
  }
  case OverTime::frequency:
  case OverTime::damping_ratio:
    if (const auto swings = swings_of(series))
      return what == OverTime::frequency ? swings->frequency : swings->damping_ratio;
    return extremes(series).size() < 3
               ? "it does not swing: its course has fewer than three turning points of more than 5 % of its "
                 "range"
               : "its swings take fewer than four steps each: noise, or too long a step";
  case OverTime::trajectory_l2:
    return root_mean_square(series.time, series.value);
  }
  return series.value.back();
}

std::optional<double> value_over_time(cases::OverTime what, const TimeSeries& series) {
  const auto number = number_over_time(what, series);
  const double* value = std::get_if<double>(&number);
  return value ? std::optional(*value) : std::nullopt;
}

std::optional<double> trajectory_error_percent(const TimeSeries& reference, const TimeSeries& other) {
  assert(reference.time == other.time);
  if (!are_finite(reference.value) || !are_finite(other.value)) return std::nullopt;
  std::vector<double> difference = other.value;
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= reference.value[i];
  const double size = root_mean_square(reference.time, reference.value),
               distance = root_mean_square(reference.time, difference);
  return error_percent(size, size + distance, reference.zero); // distance/size, with its care for zeros
}

std::string unit_over_time(cases::OverTime what, const std::string& unit) {
  using cases::OverTime;
  switch (what) {
  case OverTime::peak_time:
    return "s";
  case OverTime::overshoot:
    return "%";
  case OverTime::frequency:
    return "Hz";
  case OverTime::damping_ratio:
    return "1";
  case OverTime::end:
  case OverTime::settled:
  case OverTime::peak:
  case OverTime::trajectory_l2:
    break;
  }
  return unit;
}

std::optional<NumericalDamping> numerical_damping(const cases::Measure& measure, const cases::Scene& scene,
                                                  const cases::Solution& solution) {
  const auto& dynamics = scene.definition.dynamics;
  const bool is_damped = dynamics && dynamics->scheme.scheme == cases::Scheme::implicit_euler;
  if (!is_damped || !solution.trajectory || !measure.over_time) return std::nullopt;
  const auto swings = swings_of(series_of(measure, scene, solution));
  if (!swings) return std::nullopt;
  const double omega = 2 * M_PI * swings->frequency;
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
