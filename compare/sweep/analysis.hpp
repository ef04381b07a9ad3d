#pragma once

#include "compare/sweep/plan.hpp"

#include <optional>
#include <vector>

/// What a sweep's numbers say: functions of plain values. Variants that failed or could not be measured are
/// left out before.
namespace springproof::compare {

/// One variant as a point of the plane of time and error.
struct Point {
  std::string name;
  Family family;
  double seconds;       ///< > 0
  double error_percent; ///< >= 0
};

/// The points that no other one beats: none is at most as slow and at most as wrong. Of equal ones the first.
/// @return indices in the order of time
std::vector<std::size_t> pareto_front(const std::vector<Point>& points);

/// The fastest point whose error is at most a level, of one family or of all; of equally fast ones the more
/// accurate.
std::optional<std::size_t> fastest_within(const std::vector<Point>& points, double error_percent,
                                          std::optional<Family> family = std::nullopt);

/// The most accurate point that takes at most a time; of equally accurate ones the faster.
std::optional<std::size_t> most_accurate_within(const std::vector<Point>& points, double seconds);

/// The coarsest level from which on every error lies within a fraction of the last one, which is the floor
/// that refinement leads to. The last level itself: no floor is in sight. Nothing without an error on the
/// last level.
/// @param errors  per level, coarse to fine; where one is missing, no floor reaches across
std::optional<std::size_t> first_level_at_floor(const std::vector<std::optional<double>>& errors,
                                                double fraction);

} // namespace springproof::compare
