#include "compare/sweep/halving.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace springproof::compare {

namespace {

/// All numbers below n, neighbours far from each other: multiples of about the golden section of n.
std::vector<std::size_t> spread(std::size_t n) {
  auto stride = static_cast<std::size_t>(std::lround(0.618034 * static_cast<double>(n)));
  stride = std::max<std::size_t>(1, stride);
  while (std::gcd(stride, n) != 1) ++stride;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < n; ++i) order.push_back(i * stride % n);
  return order;
}

} // namespace

std::vector<std::size_t> order_of_fronts(const std::vector<Point>& points, double seconds) {
  std::vector<std::size_t> left(points.size()), order;
  std::iota(left.begin(), left.end(), 0);
  std::stable_sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(points[a].seconds, points[a].error_percent) <
           std::pair(points[b].seconds, points[b].error_percent);
  });
  while (!left.empty()) {
    std::vector<std::size_t> front, others;
    for (const std::size_t p : left) {
      const bool is_better = front.empty() || points[p].error_percent < points[front.back()].error_percent;
      (is_better ? front : others).push_back(p);
    }
    std::reverse(front.begin(), front.end());
    const auto best =
        std::find_if(front.begin(), front.end(), [&](std::size_t p) { return points[p].seconds <= seconds; });
    if (best != front.end()) {
      order.push_back(*best);
      front.erase(best);
    }
    for (const std::size_t first : {0, 1})
      for (std::size_t p = first; p < front.size(); p += 2) order.push_back(front[p]);
    left = std::move(others);
  }
  return order;
}

std::vector<std::pair<std::size_t, Point>> halve(std::size_t n_candidates, const Halving& halving) {
  std::vector<std::pair<std::size_t, Point>> answered;
  std::vector<std::pair<std::size_t, std::string>> aside; // those of the latest round first, the best first
  std::vector<std::size_t> order = spread(n_candidates);
  for (int round = 0; round < halving.n_rounds; ++round) {
    answered.clear();
    std::vector<std::pair<std::size_t, std::string>> left;
    const std::string of_round = fmt::format("of round {} of {}", round + 1, halving.n_rounds);
    for (const std::size_t candidate : order)
      if (!answered.empty() && !halving.has_time(round))
        left.emplace_back(candidate, fmt::format("the budget {} was spent", of_round));
      else if (auto point = halving.run(candidate, round))
        answered.emplace_back(candidate, std::move(*point));
    order.clear();
    if (round + 1 < halving.n_rounds) {
      std::vector<Point> points;
      for (const auto& [candidate, point] : answered) points.push_back(point);
      for (const std::size_t rank : order_of_fronts(points, halving.seconds)) {
        const auto& [candidate, point] = answered[rank];
        const bool is_last_next = round + 2 == halving.n_rounds;
        if (2 * order.size() < answered.size() || is_last_next)
          order.push_back(candidate);
        else
          left.emplace_back(candidate, fmt::format("not in the better half {}: about {:.2g} % at {} a frame",
                                                   of_round, point.error_percent, time_text(point.seconds)));
      }
    }
    aside.insert(aside.begin(), left.begin(), left.end());
  }
  for (const auto& [candidate, why] : aside) {
    if (!answered.empty())
      halving.drop(candidate, why);
    else if (auto point = halving.run(candidate, halving.n_rounds - 1))
      answered.emplace_back(candidate, std::move(*point));
  }
  return answered;
}

} // namespace springproof::compare
