#include "cases/scene/histories.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;

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
    CHECK_FALSE(has_jump({{{1, 1}, {1, 1}}}, is_load)); // by nothing
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
