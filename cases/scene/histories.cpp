#include "cases/scene/histories.hpp"

#include <algorithm>

namespace springproof::cases {

namespace {

/// After the one time and before the other.
bool jumps_between(const History& history, double begin, double end) {
  const auto is_jump = [&](const auto& from, const auto& to) {
    return from[0] == to[0] && from[1] != to[1] && from[0] > begin && from[0] < end;
  };
  return std::adjacent_find(history.points.begin(), history.points.end(), is_jump) != history.points.end();
}

} // namespace

bool has_load_histories(const Scene& scene) {
  return std::any_of(scene.loads.begin(), scene.loads.end(), [](const auto& applied) {
    return !applied.load.history.points.empty() || applied.load.history.frequency != 0;
  });
}

bool jumps_on_the_way(const Scene& scene) {
  const double end = scene.definition.dynamics->end;
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [=](const auto& applied) { return jumps_between(applied.load.history, 0, end); }) ||
         std::any_of(scene.moved.begin(), scene.moved.end(),
                     [=](const auto& moved) { return jumps_between(moved.motion.history, 0, end); });
}

} // namespace springproof::cases
