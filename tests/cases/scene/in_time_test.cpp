#include "cases/scene/in_time.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

Region region_named(const std::string& name) {
  Region result;
  result.name = name;
  return result;
}

Case short_bar() {
  Case definition;
  definition.body = Box{{20, 10, 10}, {2, 1, 1}};
  definition.fixed.push_back({region_named("x-"), {true, true, true}});
  return definition;
}

} // namespace

TEST_CASE("a motion starts from what acts just before time 0") {
  Case definition = short_bar();
  Load released, later;
  released.region = later.region = region_named("x+");
  released.kind = later.kind = LoadKind::total_force;
  released.value = {0, 0, -2};
  released.history.points = {{0., 0.5}, {0., 0.}};
  later.value = {1, 0, 0};
  later.history.points = {{0., 0.}, {1., 1.}};
  definition.loads = {released, later};
  const Scene still = scene_before_start(make_scene(definition));
  CHECK_FALSE(still.definition.dynamics);
  CHECK((still.loads[0].load.value - Vector3d(0, 0, -1)).norm() == 0);
  CHECK(still.loads[1].load.value.norm() == 0);
  CHECK(still.definition.loads[0].value == still.loads[0].load.value);
}

TEST_CASE("the nodes of all measures are watched, each once, and volumes where one is asked for") {
  Case definition = short_bar();
  Measure top, tilt;
  top.kind = MeasureKind::displacement;
  top.node = region_named("x+ y+ z+");
  tilt.kind = MeasureKind::tilt;
  tilt.top = region_named("x+ y+ z+");
  tilt.bottom = region_named("x+ y+ z-");
  definition.measures = {top, tilt};
  Scene scene = make_scene(definition);
  const std::vector<int> nodes = watched_nodes(scene);
  REQUIRE(nodes.size() == 2);
  CHECK(scene.mesh.nodes[index(nodes[0])] == Vector3d(20, 10, 0));
  CHECK(scene.mesh.nodes[index(nodes[1])] == Vector3d(20, 10, 10));
  CHECK_FALSE(watches_volume(scene));
  scene.definition.measures[0].kind = MeasureKind::volume;
  CHECK(watches_volume(scene));
}
