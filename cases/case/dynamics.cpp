#include "cases/case/dynamics.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::cases {

namespace {

using TimedFactor = std::array<double, 2>;

/// Value of the line through two points of different times.
double between(const TimedFactor& from, const TimedFactor& to, double time) {
  const double way = (time - from[0]) / (to[0] - from[0]);
  return (1 - way) * from[1] + way * to[1];
}

/// @param next  first point that is later, or not earlier, than the time
double value_before(const std::vector<TimedFactor>& points, std::vector<TimedFactor>::const_iterator next,
                    double time) {
  if (next == points.begin()) return points.front()[1];
  if (next == points.end()) return points.back()[1];
  return between(*(next - 1), *next, time);
}

} // namespace

int Dynamics::n_steps() const {
  return static_cast<int>(std::lround(end / step));
}

double History::at(double time) const {
  if (frequency != 0) return std::sin(2 * std::acos(-1.0) * frequency * time);
  if (points.empty()) return 1;
  const auto is_later = [](double t, const TimedFactor& point) { return t < point[0]; };
  return value_before(points, std::upper_bound(points.begin(), points.end(), time, is_later), time);
}

double History::just_before(double time) const {
  if (points.empty()) return at(time);
  const auto is_earlier = [](const TimedFactor& point, double t) { return point[0] < t; };
  return value_before(points, std::lower_bound(points.begin(), points.end(), time, is_earlier), time);
}

bool History::jumps() const {
  const auto is_jump = [](const TimedFactor& from, const TimedFactor& to) { return from[0] == to[0]; };
  return std::adjacent_find(points.begin(), points.end(), is_jump) != points.end();
}

} // namespace springproof::cases
