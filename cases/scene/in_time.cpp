#include "cases/scene/scene.hpp"

#include <algorithm>

namespace springproof::cases {

namespace {

/// Whether the history jumps after `begin` and before `end`.
bool jumps_between(const History& history, double begin, double end) {
  const auto is_jump = [&](const auto& from, const auto& to) {
    return from[0] == to[0] && from[1] != to[1] && from[0] > begin && from[0] < end;
  };
  return std::adjacent_find(history.points.begin(), history.points.end(), is_jump) != history.points.end();
}

/// The static scene with the factors of one time.
/// @param factor  returns a history's
template<class Factor>
Scene still_scene(const Scene& scene, const Factor& factor) {
  Scene still = scene;
  for (Scene::AppliedLoad& applied : still.loads) {
    Load& load = applied.load;
    load.scale(factor(load.history));
    load.history = {};
  }
  for (auto& [selection, motion] : still.moved) {
    const double part = factor(motion.history);
    motion.displacement *= part;
    motion.angle *= part;
    motion.history = {};
  }
  Case& definition = still.definition;
  definition.dynamics.reset();
  definition.loads.clear();
  for (const auto& applied : still.loads) definition.loads.push_back(applied.load);
  definition.moved.clear();
  for (const auto& moved : still.moved) definition.moved.push_back(moved.motion);
  return still;
}

} // namespace

Scene scene_before_start(const Scene& scene) {
  return still_scene(scene, [](const History& history) { return history.just_before(0); });
}

Scene scene_at_end(const Scene& scene) {
  return still_scene(
      scene, [end = scene.definition.dynamics->end](const History& history) { return history.at(end); });
}

bool has_load_histories(const Scene& scene) {
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [](const auto& applied) { return applied.load.history.is_given(); });
}

bool jumps_on_the_way(const Scene& scene) {
  const double end = scene.definition.dynamics->end;
  return std::any_of(scene.loads.begin(), scene.loads.end(),
                     [=](const auto& applied) { return jumps_between(applied.load.history, 0, end); }) ||
         std::any_of(scene.moved.begin(), scene.moved.end(),
                     [=](const auto& moved) { return jumps_between(moved.motion.history, 0, end); });
}

std::vector<int> watched_nodes(const Scene& scene) {
  std::vector<int> nodes;
  for (const Measure& measure : scene.definition.measures)
    for_each_region(measure, [&](const Region& region, bool is_node) {
      if (!is_node) return;
      for (const NodeWeight& watched : weights_at(scene.mesh, region)) nodes.push_back(watched.node);
    });
  make_set(nodes);
  return nodes;
}

bool watches_volume(const Scene& scene) {
  const auto& measures = scene.definition.measures;
  return std::any_of(measures.begin(), measures.end(), is<measures::Volume, Measure>);
}

} // namespace springproof::cases
