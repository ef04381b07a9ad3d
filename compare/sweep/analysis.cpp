#include "compare/sweep/analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace springproof::compare {

namespace {

/// The best of the points that are allowed, by a key that is to be small.
template<class IsAllowed, class Key>
std::optional<std::size_t> best(const std::vector<Point>& points, const IsAllowed& is_allowed,
                                const Key& key) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (is_allowed(points[i]) && (!found || key(points[i]) < key(points[*found]))) found = i;
  return found;
}

std::tuple<double, double> speed_first(const Point& p) {
  return {p.seconds, p.error_percent};
}

} // namespace

std::vector<std::size_t> pareto_front(const std::vector<Point>& points) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return speed_first(points[a]) < speed_first(points[b]);
  });
  std::vector<std::size_t> front;
  double least_error = std::numeric_limits<double>::infinity();
  for (const std::size_t i : order) {
    if (!(points[i].error_percent < least_error)) continue;
    least_error = points[i].error_percent;
    front.push_back(i);
  }
  return front;
}

std::optional<std::size_t> fastest_within(const std::vector<Point>& points, double error_percent,
                                          std::optional<Family> family) {
  const auto is_allowed = [&](const Point& p) {
    return p.error_percent <= error_percent && (!family || p.family == *family);
  };
  return best(points, is_allowed, speed_first);
}

std::optional<std::size_t> most_accurate_within(const std::vector<Point>& points, double seconds) {
  return best(
      points, [&](const Point& p) { return p.seconds <= seconds; },
      [](const Point& p) { return std::tuple(p.error_percent, p.seconds); });
}

std::optional<std::size_t> first_level_at_floor(const std::vector<std::optional<double>>& errors,
                                                double fraction) {
  if (errors.empty() || !errors.back()) return std::nullopt;
  const double floor = *errors.back();
  std::size_t level = errors.size() - 1;
  while (level > 0 && errors[level - 1] && std::abs(*errors[level - 1] - floor) <= fraction * floor) --level;
  return level;
}

} // namespace springproof::compare
