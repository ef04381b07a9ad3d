#pragma once

#include "compare/sweep/write_sweep.hpp"

#include <functional>

/// Successive halving of ways to answer a case (Jamieson and Talwalkar 2016), by time and error at once.
namespace springproof::compare {

/// Sorts points by fronts: those of the Pareto front, those of the front without them, and so on. Of a front
/// first comes the most accurate point within a time, then every second one from the most accurate on, then
/// the others.
/// @return places in `points`
std::vector<std::size_t> order_of_fronts(const std::vector<Point>& points, double seconds);

/// How candidates, counted from 0, are run and dropped.
struct Halving {
  int n_rounds;   ///< the last follows a candidate through
  double seconds; ///< that the best is to keep
  std::function<std::optional<Point>(std::size_t candidate, int round)>
      run;                                 ///< nothing of one that has failed
  std::function<bool(int round)> has_time; ///< whether another candidate may be run in the round
  std::function<void(std::size_t candidate, const std::string& why)> drop;
};

/// Runs all candidates, the better half of them for longer, and so on. A round takes them by their order, the
/// first one spread over all, until its time is over, but at least one that answers. The last round goes on
/// with the lesser half as long as there is time. Where all of them fail, it goes on with those that were
/// left behind before, the latest and best first, until one answers.
/// @return those that the last round has followed through, with their points
std::vector<std::pair<std::size_t, Point>> halve(std::size_t n_candidates, const Halving& halving);

} // namespace springproof::compare
