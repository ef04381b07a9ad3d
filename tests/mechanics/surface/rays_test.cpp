#include "mechanics/surface/rays.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

using namespace springproof;

using Eigen::Vector3d;
using mechanics::Ray;

namespace {

std::vector<Vector3d> scattered(std::size_t n) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = static_cast<double>(i);
    points.push_back(10 * Vector3d(std::sin(12.9 * k), std::sin(78.2 * k + 1), std::sin(37.7 * k + 2)));
  }
  return points;
}

} // namespace

TEST_CASE("a ray meets a triangle at the distance of its plane, at edges and corners too", "[verification]") {
  const std::array<Vector3d, 3> triangle{Vector3d(0, 0, 1), Vector3d(2, 0, 1), Vector3d(0, 2, 1)};
  const Vector3d up(0, 0, 3); // its length does not matter
  for (const Vector3d& from :
       {Vector3d(0.5, 0.5, 0), Vector3d(0, 0, 0), Vector3d(1, 1, 0), Vector3d(1, 0, 0)})
    CHECK(mechanics::distance_along({from, up}, triangle).value() == Approx(1).epsilon(1e-14));
  CHECK(mechanics::distance_along({{0.5, 0.5, 4}, up}, triangle).value() == Approx(-3).epsilon(1e-14));
  CHECK_FALSE(mechanics::distance_along({{1.1, 1, 0}, up}, triangle));
  CHECK_FALSE(mechanics::distance_along({{-0.01, 1, 0}, up}, triangle));
  CHECK_FALSE(mechanics::distance_along({{0.5, 0.5, 0}, {1, 0, 0}}, triangle));
  CHECK_FALSE(mechanics::distance_along({{-1, 0.5, 1}, {1, 0, 0}}, triangle)); // parallel to its plane
  const double nan = std::nan("");
  CHECK_FALSE(mechanics::distance_along({{nan, 0, 0}, up}, triangle));
}

TEST_CASE("the distance to a surface is that of the nearer side") {
  const cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  const cases::TriangleMesh box = cases::triangles_of_faces(mesh, cases::boundary_faces(mesh));
  const auto distance = [&](const Vector3d& from, const Vector3d& along) {
    return mechanics::distance_to_surface({from, along}, box.triangles, box.vertices);
  };
  CHECK(distance({0.5, 0.7, 0.4}, {0, 0, 1}).value() == Approx(0.4));
  CHECK(distance({0.5, 0.7, 0.4}, {0, 0, -1}).value() == Approx(0.4));
  CHECK(distance({1, 1, 1.5}, {0, 0, 2}).value() == Approx(0.5)); // it hits a vertex of six triangles
  CHECK_FALSE(distance({5, 5, 5}, {0, 0, 1}));
}

TEST_CASE("spheres hold every vertex, as many as asked for, and no more than there are vertices") {
  const std::vector<Vector3d> points = scattered(500);
  double before = std::numeric_limits<double>::infinity();
  for (const std::size_t n : {1, 7, 50, 271}) {
    const mechanics::Spheres spheres = mechanics::cover(points, n);
    CHECK(spheres.vertices.size() == n);
    CHECK(std::set<int>(spheres.vertices.begin(), spheres.vertices.end()).size() == n);
    for (const Vector3d& point : points) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const int centre : spheres.vertices)
        nearest = std::min(nearest, (points[cases::index(centre)] - point).norm());
      REQUIRE(nearest <= spheres.radius * (1 + 1e-14));
    }
    CHECK(spheres.radius < before);
    before = spheres.radius;
  }
  CHECK(mechanics::cover(points, 10000).vertices.size() == points.size());
  CHECK(mechanics::cover(points, 10000).radius == 0);
}

TEST_CASE("a ray picks the sphere that it enters first, where the surface is now") {
  const mechanics::Spheres spheres{{0, 2, 1}, 1};
  std::vector<Vector3d> positions{{0, 0, 0}, {0, 0, 5}, {0, 0.5, 10}};
  const auto picked = [&](const Vector3d& from, const Vector3d& along) {
    return mechanics::pick(spheres, positions, {from, along});
  };
  CHECK(picked({0, 0, -10}, {0, 0, 1}) == std::size_t{0});
  CHECK(picked({0, 0, 20}, {0, 0, -4}) == std::size_t{1});
  CHECK(picked({0, 0, 2}, {0, 0, 1}) == std::size_t{2});   // the first one is behind
  CHECK(picked({0, 0, 0.5}, {0, 0, 1}) == std::size_t{0}); // begins in it
  CHECK_FALSE(picked({3, 0, -10}, {0, 0, 1}));
  CHECK_FALSE(picked({0, 0, -10}, {0, 0, -1}));
  CHECK_FALSE(picked({std::nan(""), 0, 0}, {0, 0, 1}));
  positions[0] = {3, 0, 0};
  CHECK(picked({3, 0, -10}, {0, 0, 1}) == std::size_t{0});
  CHECK(picked({0, 0, -10}, {0, 0, 1}) == std::size_t{2});
}
