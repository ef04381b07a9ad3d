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
  const Mesh box = make_box_mesh(upper - lower, {1, 1, 1});
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

Mesh voxels(const std::string& facets, double edge) {
  const TemporaryFolder folder;
  return make_voxel_mesh({{folder.write("body.stl", "solid\n" + facets + "endsolid\n")}, edge});
}

} // namespace

TEST_CASE("a cuboid becomes the box that it is, wherever it lies") {
  const Mesh mesh = voxels(cuboid({-1, 2, 0.5}, {1, 3, 2}), 0.25);
  REQUIRE(mesh.grid);
  CHECK(mesh.grid->cells == std::array<int, 3>{8, 4, 6});
  CHECK(mesh.cells.size() == 8 * 4 * 6);
  CHECK(mesh.nodes.front() == Vector3d(-1, 2, 0.5));
  CHECK((mesh.nodes.back() - Vector3d(1, 3, 2)).norm() <= 1e-14); // rounding of 8 * 0.25
}

TEST_CASE("a cuboid far from the origin has no layer of cells more for the rounding of its coordinates") {
  const Mesh mesh = voxels(cuboid({-1.1, 2.3, 100.7}, {-0.5, 2.6, 101.6}), 0.3);
  CHECK(mesh.grid->cells == std::array<int, 3>{2, 1, 3});
  CHECK(mesh.cells.size() == 2 * 1 * 3);
}

TEST_CASE("a ball of cubes has nearly its volume, and is as symmetric") {
  const Mesh mesh = voxels(ball(), 0.1);
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
  const Mesh box = make_box_mesh({1, 1, 1}, {1, 1, 1});
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
  check(cuboid({0, 0, 0}, {0.1, 0.04, 0.05}), 1, "the file's body is 0.1 x 0.04 x 0.05 mm");
  check(cuboid({0, 0, 0}, {0.1, 0.04, 0.05}), 1, "body.scale says how many mm");
}

TEST_CASE("a surface in metres is scaled to mm, and so is the count of its cubes") {
  const TemporaryFolder folder;
  const Voxels body{
      {folder.write("a.stl", "solid\n" + cuboid({0, 0, 0}, {0.25, 0.5, 0.125}) + "endsolid\n")}, 125, 1000};
  CHECK(make_voxel_mesh(body).cells.size() == 2 * 4 * 1);
  CHECK(count_voxels(body).in_body == Approx(8).epsilon(1e-6)); // single precision
}

// Other places checked for this defect: the same file as [surface] (read_surface() reads it here), .vtp
// (joined() drops such triangles), meshes (check_mesh_test.cpp), springs of a network (network_test.cpp).
TEST_CASE(
    "triangles that are there twice or have no area, and bytes after the last, are left out with a word") {
  const std::string body = cuboid({0, 0, 0}, {2, 2, 2});
  const auto remarks_of = [](const std::string& name, const std::string& content) {
    const TemporaryFolder folder;
    std::vector<std::string> remarks;
    CHECK(make_voxel_mesh({{folder.write(name, content)}, 1}, &remarks).cells.size() == 8);
    return fmt::format("{}", fmt::join(remarks, "; "));
  };
  const auto of_text = [&](const std::string& facets) {
    return remarks_of("a.stl", "solid\n" + facets + "endsolid\n");
  };
  CHECK(of_text(body).empty());
  CHECK_THAT(of_text(body + body), Catch::Contains("a.stl: 12 triangles that are there before are left out"));
  const std::string needle = facet({0, 0, 0}, {1, 1, 1}, {2, 2, 2}) + facet({2, 2, 2}, {1, 1, 1}, {0, 0, 0}),
                    point = facet({0, 0, 0}, {0, 0, 0}, {2, 0, 0});
  CHECK_THAT(of_text(body + needle + point), Catch::Contains("3 triangles without an area bound nothing"));

  const TemporaryFolder folder;
  const Surface surface = read_body_surface({folder.write("a.stl", "solid\n" + body + "endsolid\n")});
  std::string binary(80, ' ');
  const auto append = [&](auto value) { binary.append(reinterpret_cast<const char*>(&value), sizeof value); };
  append(static_cast<std::uint32_t>(surface.size()));
  for (const auto& triangle : surface) {
    for (int i = 0; i < 3; ++i) append(0.F);
    for (const Vector3d& vertex : triangle)
      for (int a = 0; a < 3; ++a) append(static_cast<float>(vertex[a]));
    append(std::uint16_t{0});
  }
  CHECK(remarks_of("b.stl", binary).empty());
  for (const std::size_t n : {1u, 7u, 50u, 100u, 123u}) { // a part of a triangle, and some
    CAPTURE(n);
    CHECK_THAT(remarks_of("b.stl", binary + std::string(n, '\x3f')),
               Catch::Contains(fmt::format("b.stl: {} bytes after the last triangle are left out", n)));
  }
}

TEST_CASE("the number of cubes is known from the surface, without making them") {
  const TemporaryFolder folder;
  const auto count = [&](const std::string& facets, double edge) {
    return count_voxels({{folder.write("body.stl", "solid\n" + facets + "endsolid\n")}, edge}).in_body;
  };
  CHECK(count(cuboid({-1, 2, 0.5}, {1, 3, 2}), 0.25) == Approx(8 * 4 * 6).epsilon(1e-6)); // single precision
  CHECK(count(cuboid({100, 2, 0.5}, {103, 3, 2}), 1e-4) == Approx(4.5e12).epsilon(1e-4));
  CHECK(count(ball(), 0.1) == Approx(double(voxels(ball(), 0.1).cells.size())).epsilon(0.1));
}
