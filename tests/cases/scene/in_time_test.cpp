#include "cases/scene/scene.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

Case short_bar() {
  Case definition;
  definition.body = Box{{20, 10, 10}, {2, 1, 1}};
  definition.fixed.push_back({{"x-"}, {true, true, true}});
  return definition;
}

} // namespace

TEST_CASE("a motion starts from what acts just before time 0") {
  Case definition = short_bar();
  definition.loads = {{{"x+"}, loads::TotalForce{{0, 0, -2}}, {{{0., 0.5}, {0., 0.}}}},
                      {{"x+"}, loads::TotalForce{{1, 0, 0}}, {{{0., 0.}, {1., 1.}}}}};
  const Scene still = scene_before_start(make_scene(definition));
  CHECK_FALSE(still.definition.dynamics);
  const auto force = [](const Load& load) { return std::get<loads::TotalForce>(load.kind).value; };
  CHECK((force(still.loads[0].load) - Vector3d(0, 0, -1)).norm() == 0);
  CHECK(force(still.loads[1].load).norm() == 0);
  CHECK(force(still.definition.loads[0]) == force(still.loads[0].load));
}

TEST_CASE("the scene at a motion's end has the factors of that time") {
  Case definition = short_bar();
  definition.dynamics.emplace().end = 0.5;
  definition.loads = {{{"x+"}, loads::TotalForce{{1, 0, 0}}, {{{0., 0.}, {1., 1.}}}}};
  const Scene still = scene_at_end(make_scene(definition));
  CHECK_FALSE(still.definition.dynamics);
  CHECK(std::get<loads::TotalForce>(still.loads[0].load.kind).value == Vector3d(0.5, 0, 0));
}

TEST_CASE("the nodes of all measures are watched, each once, and volumes where one is asked for") {
  Case definition = short_bar();
  definition.measures = {{"", measures::Displacement{{"x+ y+ z+"}}},
                         {"", measures::Tilt{{"x+ y+ z+"}, {"x+ y+ z-"}}}};
  Scene scene = make_scene(definition);
  const std::vector<int> nodes = watched_nodes(scene);
  REQUIRE(nodes.size() == 2);
  CHECK(scene.mesh.nodes[index(nodes[0])] == Vector3d(20, 10, 0));
  CHECK(scene.mesh.nodes[index(nodes[1])] == Vector3d(20, 10, 10));
  CHECK_FALSE(watches_volume(scene));
  scene.definition.measures[0].kind = measures::Volume{};
  CHECK(watches_volume(scene));
}

TEST_CASE("a factor that jumps between the ends of a motion is found, in loads and in moved regions") {
  const auto has_jump = [](const History& history, bool is_load) {
    Scene scene;
    scene.definition.dynamics.emplace().end = 2;
    if (is_load)
      scene.loads.emplace_back().load.history = history;
    else
      scene.moved.emplace_back().motion.history = history;
    return jumps_on_the_way(scene);
  };
  for (const bool is_load : {true, false}) {
    CHECK(has_jump({{{1, 0}, {1, 1}}}, is_load));
    CHECK(has_jump({{{0, 0}, {1, 0.5}, {1, 2}, {2, 0}}}, is_load));
    CHECK_FALSE(has_jump({{{0, 1}, {0, 0}}}, is_load)); // the motion starts with it
    CHECK_FALSE(has_jump({{{2, 1}, {2, 0}}}, is_load)); // and has ended
    CHECK_FALSE(has_jump({{{1, 1}, {1, 1}}}, is_load)); // jumps by nothing
    CHECK_FALSE(has_jump({{{0, 0}, {1, 1}}}, is_load));
    CHECK_FALSE(has_jump({}, is_load));
  }
}

TEST_CASE("a load follows a history if it has points or a frequency") {
  Scene scene;
  scene.loads.resize(2);
  CHECK_FALSE(has_load_histories(scene));
  History& history = scene.loads[1].load.history;
  history.points = {{0, 1}};
  CHECK(has_load_histories(scene));
  history.points.clear();
  history.frequency = 3;
  CHECK(has_load_histories(scene));
}
