#include "cases/mesh/closed_surface.hpp"

#include "tests/support/tool_surfaces.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

const NamedFile file{"probe.stl"};

TriangleMesh rigid(const Surface& triangles, std::vector<std::string>& remarks) {
  return rigid_surface(triangles, 1, file, remarks);
}

Surface with(Surface surface, const Surface& other) {
  surface.insert(surface.end(), other.begin(), other.end());
  return surface;
}

Surface turned(Surface surface) {
  for (auto& triangle : surface) std::swap(triangle[1], triangle[2]);
  return surface;
}

} // namespace

TEST_CASE("a rigid surface has its file's triangles, at its scale, from outside anticlockwise") {
  const Surface cuboid = tool_surfaces::box({0, 0, 0}, {1, 2, 3});
  std::vector<std::string> remarks;
  const TriangleMesh found = rigid_surface(cuboid, 2, file, remarks);
  CHECK(found.vertices.size() == 8);
  CHECK(found.triangles.size() == 12);
  CHECK(volumes_of_parts(found) == std::vector<double>{48});
  CHECK(remarks.empty());
  CHECK(volumes_of_parts(rigid(turned(cuboid), remarks)) == std::vector<double>{6});
  REQUIRE(remarks.size() == 1);
  CHECK(remarks[0] == "probe.stl: its triangles are seen from outside clockwise, and are turned over");
  CHECK(volumes_of_parts(rigid(with(cuboid, tool_surfaces::box({2, 0, 0}, {3, 1, 1})), remarks)) ==
        std::vector<double>{6, 1});
}

TEST_CASE("a surface that bounds no rigid body is refused with its file's name and what to do") {
  const Surface cuboid = tool_surfaces::box({0, 0, 0}, {1, 2, 3});
  std::vector<std::string> remarks;
  const auto refused = [&](const Surface& surface, const std::string& says) {
    CHECK_THROWS_WITH(rigid(surface, remarks), Contains("probe.stl") && Contains(says));
  };
  Surface open = cuboid, half_turned = cuboid;
  open.pop_back();
  std::swap(half_turned[3][0], half_turned[3][1]);
  refused(open, "is open: 3 of its edges belong to one triangle, one of them from (1, 0, 0) to (1, 0, 3) mm");
  refused(half_turned, "has triangles that are turned over: 3 of its edges");
  refused(with(cuboid, tool_surfaces::box({1, 2, 0}, {2, 3, 3})),
          "1 of its edges belong to more than two triangles");
  refused(with(cuboid, turned(tool_surfaces::box({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}))),
          "has 1 of 2 parts whose triangles are turned the other way than the rest");
  refused(with(cuboid, turned(cuboid)), "more than two triangles");
  refused(with({cuboid[0]}, turned({cuboid[0]})), "encloses no volume");
  Surface needle =
      tool_surfaces::box({0, 0, 0}, {1, 2, 3}); // its first edge has a triangle between both of its own
  const auto [a, b, c] = needle[0];
  needle[0] = {Vector3d((a + b) / 2), b, c};
  needle.push_back({a, Vector3d((a + b) / 2), c});
  needle.push_back({a, b, Vector3d((a + b) / 2)});
  refused(needle, "has a triangle without an area at (0, 0, 0) mm");
  refused({{Vector3d::Zero(), Vector3d::Zero(), Vector3d::UnitX()}}, "three different corners");
  refused(Surface(500'001, cuboid[0]), "has 500001 triangles, must have at most 500000");
  for (const double scale : {1e-9, 1e9, 1e308})
    CHECK_THROWS_WITH(rigid_surface(cuboid, scale, file, remarks), Contains("must reach 1e-6 to 1e9; scale"));
}
