#include "cases/scene/in_time.hpp"

#include <algorithm>

namespace springproof::cases {

Scene scene_before_start(const Scene& scene) {
  Scene still = scene;
  for (Scene::AppliedLoad& applied : still.loads) {
    Load& load = applied.load;
    const double factor = load.history.just_before(0);
    load.value *= factor;
    load.moment *= factor;
    load.history = {};
  }
  for (auto& [selection, motion] : still.moved) {
    const double factor = motion.history.just_before(0);
    motion.displacement *= factor;
    motion.angle *= factor;
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

std::vector<int> watched_nodes(const Scene& scene) {
  std::vector<int> nodes;
  for (const Measure& measure : scene.definition.measures)
    for (const Region* region : {&measure.node, &measure.top, &measure.bottom, &measure.centre})
      if (region->near || !region->name.empty()) nodes.push_back(select_node(scene.mesh, *region));
  make_set(nodes);
  return nodes;
}

bool watches_volume(const Scene& scene) {
  const auto& measures = scene.definition.measures;
  return std::any_of(measures.begin(), measures.end(),
                     [](const Measure& measure) { return measure.kind == MeasureKind::volume; });
}

} // namespace springproof::cases
