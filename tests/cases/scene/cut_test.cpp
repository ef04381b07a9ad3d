#include "cases/scene/scene.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

Region part(const Vector3d& lower, const Vector3d& upper) {
  Region region;
  region.name = "part";
  region.part = Part{"", lower, upper};
  return region;
}

/// 10 x 2 x 4 cells of 1 mm; the bone under it is held up to x = 4 and set back by 2 mm from x = 6 on.
Case set_back() {
  Case definition;
  definition.body = Box{{10, 2, 4}, {10, 2, 4}};
  definition.fixed.push_back({part({0, 0, 0}, {4, 2, 0})});
  Moved bone;
  bone.region = part({6, 0, 0}, {10, 2, 0});
  bone.displacement = {-2, 0, 0};
  definition.moved = {bone};
  definition.removed = {{{4, 0, 0}, {6, 2, 3}, Axis::x, {}}};
  return definition;
}

ScaledDisplacement scaled(const Vector3d& point, const Vector3d& normal, double length) {
  return {point, normal, length, {}};
}

} // namespace

TEST_CASE("a scaled displacement is none up to the zone, whole beyond it, and linear between") {
  Moved motion;
  motion.displacement = {-3, 0, 1};
  motion.scaled.emplace(scaled({0, 0, 2}, {0, 0, 1}, 4));
  CHECK(moved_by(motion, {7, 8, -5}, 1) == Vector3d(0, 0, 0));
  CHECK(moved_by(motion, {7, 8, 2}, 1) == Vector3d(0, 0, 0));
  CHECK(moved_by(motion, {7, 8, 3}, 1) == 0.25 * motion.displacement);
  CHECK(moved_by(motion, {7, 8, 3}, 0.5) == 0.125 * motion.displacement);
  CHECK(moved_by(motion, {7, 8, 6}, 1) == motion.displacement);
  CHECK(moved_by(motion, {7, 8, 60}, 1) == motion.displacement);
}

TEST_CASE("a scaled turn goes round the axis by a part of its angle") {
  Moved motion;
  motion.angle = 90;
  motion.scaled.emplace(scaled({0, 0, 0}, {0, 0, 1}, 2));
  const Vector3d half = moved_by(motion, {1, 0, 1}, 1);                            // 45 degrees
  CHECK((half - Vector3d(std::sqrt(0.5) - 1, std::sqrt(0.5), 0)).norm() <= 1e-15); // rounding
}

TEST_CASE("a scaled zone without nodes, and one that no node is beyond, are refused") {
  Case definition;
  definition.body = Box{{4, 1, 1}, {4, 1, 1}};
  Moved bone;
  bone.region.name = "z-";
  bone.displacement = {-0.1, 0, 0};
  const auto scene_with = [&](const ScaledDisplacement& zone) {
    bone.scaled = zone;
    definition.moved = {bone};
    return make_scene(definition);
  };
  CHECK_NOTHROW(scene_with(scaled({1, 0, 0}, {1, 0, 0}, 2)));
  CHECK_THROWS_WITH(scene_with(scaled({1, 0, 0}, {1, 0, 0}, 0.5)), Catch::Contains("within the zone"));
  CHECK_THROWS_WITH(scene_with(scaled({1, 0, 0}, {1, 0, 0}, 9)), Catch::Contains("beyond the zone"));
}

TEST_CASE("the cells of a removed piece are gone, with the nodes that no other cell has") {
  const Scene scene = make_scene(set_back());
  CHECK(scene.mesh.cells.size() == 80 - 2 * 2 * 3);
  CHECK(scene.mesh.nodes.size() == 11 * 3 * 5 - 1 * 3 * 3); // those at x = 5 below the cells that are left
  REQUIRE(scene.mesh.grid);
  CHECK_FALSE(scene.mesh.grid->has(4, 0, 2));
  CHECK(scene.mesh.grid->has(4, 0, 3));
}

TEST_CASE("the sides of a joined cut move as their bone does, but for nodes of cells that are left between") {
  const Scene scene = make_scene(set_back());
  REQUIRE(scene.moved.size() == 3); // the bone, and both sides
  const double planes[] = {4, 6}, displacements[] = {0, -2};
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& [selection, motion] = scene.moved[1 + side];
    CHECK(motion.components == std::array<bool, 3>{true, false, false});
    CHECK(motion.displacement == Vector3d(displacements[side], 0, 0));
    CHECK(selection.nodes.size() == 2 * 3); // z = 1 and 2: z = 0 is bone, z = 3 is of the cells above
    CHECK(selection.faces.size() == 2);
    for (const int node : selection.nodes) {
      const Vector3d place = scene.mesh.nodes[index(node)];
      CHECK(place.x() == planes[side]);
      CHECK((place.z() == 1 || place.z() == 2));
    }
  }
}

TEST_CASE("a cut through the whole body is no one body") {
  Case definition = set_back();
  definition.removed[0].upper.z() = 4;
  CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("falls into 2 pieces"));
}

TEST_CASE("pieces that are empty, overlap or take everything are refused") {
  Case definition = set_back();
  SECTION("empty") {
    definition.removed[0].lower.x() = 5.6;
    definition.removed[0].upper.x() = 6.4;
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("no cell has its centre in the box"));
  }
  SECTION("overlapping") {
    definition.removed.push_back({{5, 0, 0}, {7, 2, 1}, std::nullopt, {}});
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("overlaps another piece"));
  }
  SECTION("everything") {
    definition.removed = {{{0, 0, 0}, {10, 2, 4}, std::nullopt, {}}};
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("nothing is left"));
  }
}

TEST_CASE("sides that do not meet, that nothing moves, or of a piece at the end are not joined") {
  Case definition = set_back();
  SECTION("do not meet") {
    definition.moved[0].displacement.x() = -1.5;
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("end 0.5 mm apart along x"));
  }
  SECTION("not moved as a whole") {
    definition.moved[0].displacement = Vector3d::Zero();
    definition.moved[0].angle = 5;
    definition.moved[0].axis = Vector3d::UnitZ();
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("upper side is not moved as a whole"));
  }
  SECTION("nothing moves the side") {
    definition.fixed[0].region = part({0, 0, 0}, {3, 2, 0});
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("no node of its lower side is fixed or moved"));
  }
  SECTION("at the end") {
    definition.removed[0].lower.x() = 6;
    definition.removed[0].upper.x() = 10;
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("nothing on one side along x"));
  }
  SECTION("one layer of cells") {
    definition.removed[0].upper.z() = 1;
    CHECK_THROWS_WITH(make_scene(definition), Catch::Contains("no free node to join"));
  }
}

TEST_CASE("a joined cut is refused on a finer mesh, and an open one is refined with the body") {
  Case definition = set_back();
  CHECK_THROWS_WITH(refine(make_scene(definition), 1), Catch::Contains("finer mesh"));
  definition.removed[0].join.reset();
  CHECK(refine(make_scene(definition), 1).mesh.cells.size() == 8 * (80 - 12));
}
