#include "cases/case/case.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

constexpr double rounding = 1e-9; // relative, of turns and steps

struct Turn {
  double degrees, begin; ///< the step with the largest turn; s
};

/// Finds the largest turn among steps of equal length.
Turn largest_turn_of_steps(const Moved& moved, double end, long n_steps) {
  Turn largest{0, 0};
  const auto time = [&](long step) {
    return end * (static_cast<double>(step) / static_cast<double>(n_steps));
  };
  for (long step = 0; step < n_steps; ++step) {
    const auto [least, most] = moved.history.factors_between(time(step), time(step + 1));
    const double degrees = std::abs(moved.angle) * (most - least);
    if (!(degrees <= largest.degrees)) largest = {degrees, time(step)};
  }
  return largest;
}

bool is_small(const Turn& turn) {
  return turn.degrees <= largest_turn_of_step * (1 + rounding);
}

/// Number of steps to the end that makes them short enough; nothing: more than a case may have.
std::optional<long> enough_steps(const Moved& moved, double end, long n_steps) {
  while (static_cast<double>(n_steps) <= most_time_steps) {
    const Turn turn = largest_turn_of_steps(moved, end, n_steps);
    if (is_small(turn)) return n_steps;
    const double more = static_cast<double>(n_steps) * (turn.degrees / largest_turn_of_step);
    if (!(more <= most_time_steps)) break;
    n_steps = std::max(n_steps + 1, std::lround(std::ceil(more * (1 - rounding))));
  }
  return std::nullopt;
}

} // namespace

Eigen::Vector3d Tool::place_on_path(double time) const {
  const auto is_later = [](double t, const std::array<double, 4>& point) { return t < point[0]; };
  const auto place = [](const std::array<double, 4>& point) {
    return Eigen::Vector3d(point[1], point[2], point[3]);
  };
  const auto next = std::upper_bound(path.begin(), path.end(), time, is_later);
  if (next == path.begin()) return place(path.front());
  const auto last = std::prev(next);
  if (next == path.end()) return place(*last);
  const double way = (time - (*last)[0]) / ((*next)[0] - (*last)[0]);
  return (1 - way) * place(*last) + way * place(*next);
}

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

std::array<double, 2> History::factors_between(double begin, double end) const {
  double least = std::min(at(begin), just_before(end)), most = std::max(at(begin), just_before(end));
  const auto add = [&](double factor) {
    least = std::min(least, factor);
    most = std::max(most, factor);
  };
  if (frequency != 0) { // a crest of sin(2 pi x) at every x = k + 1/4, a trough at k + 3/4
    const double from = frequency * begin, to = frequency * end;
    if (std::floor(to - 0.25) > std::floor(from - 0.25)) add(1);
    if (std::floor(to - 0.75) > std::floor(from - 0.75)) add(-1);
    return {least, most};
  }
  const auto is_earlier = [](const std::array<double, 2>& point, double time) { return point[0] < time; };
  const auto first = std::lower_bound(points.begin(), points.end(), begin, is_earlier);
  for (auto point = first; point != points.end() && (*point)[0] <= end; ++point) add((*point)[1]);
  return {least, most};
}

double largest_factor(const Moved& moved, const std::optional<Dynamics>& dynamics) {
  if (!dynamics) return 1;
  const auto [least, most] = moved.history.factors_between(0, dynamics->end);
  return std::max(std::abs(least), std::abs(most));
}

void check_turns_in_time(const Case& definition) {
  if (!definition.dynamics) return;
  const Dynamics& dynamics = *definition.dynamics;
  for (const Moved& moved : definition.moved) {
    if (moved.angle == 0) continue;
    const long n_steps = dynamics.n_steps();
    const Turn turn = largest_turn_of_steps(moved, dynamics.end, n_steps);
    if (is_small(turn)) continue;
    const auto enough = enough_steps(moved, dynamics.end, n_steps);
    refuse(moved.region.where,
           "turns by {:.4g} degrees in the step of dynamics.step = {:.10g} s that begins at {:.4g} s, must "
           "turn by at most {} in each: {}; a longer turn ends where a shorter one the other way does",
           turn.degrees, dynamics.end / static_cast<double>(n_steps), turn.begin, largest_turn_of_step,
           enough ? fmt::format("take steps of {:.10g} s or shorter",
                                dynamics.end / static_cast<double>(*enough))
                  : "it needs a slower history");
  }
}

} // namespace springproof::cases
