#include "cases/mesh/voxels.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

std::string facet(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  std::string text = "facet normal 0 0 0\nouter loop\n";
  for (const Vector3d& v : {a, b, c}) text += fmt::format("vertex {} {} {}\n", v.x(), v.y(), v.z());
  return text + "endloop\nendfacet\n";
}

/// The facets of a cuboid, seen from outside anticlockwise.
std::string cuboid(const Vector3d& lower, const Vector3d& upper) {
  const HexMesh box = make_box_mesh(upper - lower, {1, 1, 1});
  std::string text;
  for (const auto& face : boundary_faces(box)) {
    const auto corner = [&](std::size_t v) -> Vector3d {
      return lower + box.nodes[static_cast<std::size_t>(face[v])];
    };
    text += facet(corner(0), corner(1), corner(2)) + facet(corner(0), corner(2), corner(3));
  }
  return text;
}

/// A ball of radius 1 about the origin, of 2 * 20 * 40 triangles but for the poles.
std::string ball() {
  constexpr int n = 20, m = 40;
  const auto at = [](int i, int j) {
    const double u = std::acos(-1.) * i / n, v = 2 * std::acos(-1.) * (j % m) / m;
    if (i == 0 || i == n) return Vector3d(0, 0, i == 0 ? 1 : -1);
    return Vector3d(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
  };
  std::string text;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      if (i + 1 < n) text += facet(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      if (i > 0) text += facet(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return text;
}

HexMesh voxels(const std::string& facets, double edge) {
  const TemporaryFolder folder;
  return make_voxel_mesh({folder.write("body.stl", "solid\n" + facets + "endsolid\n"), edge, {}});
}

} // namespace

TEST_CASE("a cuboid becomes the box that it is, wherever it lies") {
  const HexMesh mesh = voxels(cuboid({-1, 2, 0.5}, {1, 3, 2}), 0.25);
  REQUIRE(mesh.grid);
  CHECK(mesh.grid->cells == std::array<int, 3>{8, 4, 6});
  CHECK(mesh.cells.size() == 8 * 4 * 6);
  CHECK(mesh.nodes.front() == Vector3d(-1, 2, 0.5));
  CHECK((mesh.nodes.back() - Vector3d(1, 3, 2)).norm() <= 1e-14); // rounding of 8 * 0.25
}

TEST_CASE("a cuboid far from the origin has no layer of cells more for the rounding of its coordinates") {
  const HexMesh mesh = voxels(cuboid({-1.1, 2.3, 100.7}, {-0.5, 2.6, 101.6}), 0.3);
  CHECK(mesh.grid->cells == std::array<int, 3>{2, 1, 3});
  CHECK(mesh.cells.size() == 2 * 1 * 3);
}

TEST_CASE("a ball of cubes has nearly its volume, and is as symmetric") {
  const HexMesh mesh = voxels(ball(), 0.1);
  const double volume = 1e-3 * static_cast<double>(mesh.cells.size());
  // The polyhedron has 4.146. Some 1250 cubes on its surface are in or out as at random, but 48 at a time, by
  // symmetry: three standard deviations of 48 * sqrt(1250/48/12).
  CHECK(volume == Approx(4.146).margin(0.21));
  Vector3d centre = Vector3d::Zero();
  for (const Vector3d& node : mesh.nodes) centre += node / static_cast<double>(mesh.nodes.size());
  CHECK(centre.norm() <= 1e-10); // no cell's centre is that near to the surface
}

TEST_CASE("a hollow stays empty, and overlapping parts are filled once") {
  const std::string inner = cuboid({1, 1, 1}, {2, 2, 2});
  // A cavity is seen from inside it: its facets are the other way round.
  std::string hollow = cuboid({0, 0, 0}, {3, 3, 3});
  const HexMesh box = make_box_mesh({1, 1, 1}, {1, 1, 1});
  for (const auto& face : boundary_faces(box)) {
    const auto corner = [&](std::size_t v) -> Vector3d {
      return Vector3d::Ones() + box.nodes[static_cast<std::size_t>(face[v])];
    };
    hollow += facet(corner(0), corner(2), corner(1)) + facet(corner(0), corner(3), corner(2));
  }
  CHECK(voxels(hollow, 1).cells.size() == 26);
  CHECK(voxels(cuboid({0, 0, 0}, {3, 3, 3}) + inner, 1).cells.size() == 27);
}

TEST_CASE("an open surface, pieces that share no face, an edge too small or too large are refused") {
  const std::string two = cuboid({0, 0, 0}, {2, 1, 1}) + cuboid({2, 1, 0}, {4, 2, 1}); // share an edge
  const std::string open = facet({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const auto check = [](const std::string& facets, double edge, const std::string& says) {
    CHECK_THROWS_WITH(voxels(facets, edge), Catch::Contains(says) && Catch::Contains("body.stl"));
  };
  check(open, 0.1, "is not closed: 3 edges of its 1 triangles");
  check(two, 1, "fall into 2 pieces that share no face, the largest of 2 cells");
  check(cuboid({0, 0, 0}, {1, 1, 1}), 1e-3, "needs more than");
  check(cuboid({0, 0, 0}, {1, 1, 1}), 5, "no cell of edge 5 mm has its centre inside");
}

TEST_CASE("the number of cubes is known from the surface, without making them") {
  const TemporaryFolder folder;
  const auto count = [&](const std::string& facets, double edge) {
    return count_voxels({folder.write("body.stl", "solid\n" + facets + "endsolid\n"), edge, {}}).in_body;
  };
  CHECK(count(cuboid({-1, 2, 0.5}, {1, 3, 2}), 0.25) == Approx(8 * 4 * 6).epsilon(1e-6)); // single precision
  CHECK(count(cuboid({100, 2, 0.5}, {103, 3, 2}), 1e-4) == Approx(4.5e12).epsilon(1e-4));
  CHECK(count(ball(), 0.1) == Approx(double(voxels(ball(), 0.1).cells.size())).epsilon(0.1));
}
