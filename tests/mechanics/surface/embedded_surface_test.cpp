#include "mechanics/surface/embedded_surface.hpp"

#include "cases/mesh/cell_point.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace springproof;

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

mechanics::EmbeddedSurface surface_of(const cases::Mesh& mesh) {
  return mechanics::embed(cases::triangles_of_faces(mesh, cases::boundary_faces(mesh)), mesh);
}

/// Sum over the nodes of a patch of weight times a function of their place.
template<class Function>
double mean(const std::vector<cases::WeightedPoint>& patch, const cases::Mesh& mesh,
            const Function& function) {
  double sum = 0;
  for (const auto& [node, weight] : cases::on_nodes(patch, mesh))
    sum += weight * function(mesh.nodes[cases::index(node)]);
  return sum;
}

/// A sphere about the origin, of rings between two poles.
cases::TriangleMesh sphere(double radius, int n_rings, int n_around) {
  const double half_turn = std::acos(-1.0);
  cases::TriangleMesh mesh;
  mesh.vertices.push_back({0, 0, radius});
  for (int r = 1; r < n_rings; ++r)
    for (int a = 0; a < n_around; ++a) {
      const double polar = half_turn * r / n_rings, azimuth = 2 * half_turn * a / n_around;
      mesh.vertices.push_back(radius * Vector3d(std::sin(polar) * std::cos(azimuth),
                                                std::sin(polar) * std::sin(azimuth), std::cos(polar)));
    }
  mesh.vertices.push_back({0, 0, -radius});
  const int last = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int ring, int a) { return 1 + (ring - 1) * n_around + a % n_around; };
  for (int a = 0; a < n_around; ++a) {
    mesh.triangles.push_back({0, at(1, a), at(1, a + 1)});
    mesh.triangles.push_back({at(n_rings - 1, a + 1), at(n_rings - 1, a), last});
    for (int r = 1; r + 1 < n_rings; ++r) {
      mesh.triangles.push_back({at(r, a), at(r + 1, a), at(r + 1, a + 1)});
      mesh.triangles.push_back({at(r, a), at(r + 1, a + 1), at(r, a + 1)});
    }
  }
  return mesh;
}

/// Cells between -1 and 1, of any shape when distorted.
cases::Mesh body(double distortion) {
  cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {4, 3, 5});
  std::vector<Vector3d>& nodes = mesh.nodes.stored();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const auto k = static_cast<double>(n);
    nodes[n] += distortion * Vector3d(std::sin(12.9 * k), std::sin(78.2 * k), std::sin(37.7 * k));
    nodes[n] -= Vector3d::Ones();
  }
  return mesh;
}

Matrix3d any_gradient() {
  return (Matrix3d() << 0.3, -0.2, 0.1, 0.4, -0.1, 0.2, -0.3, 0.15, 0.25).finished();
}

std::vector<Vector3d> linear_displacement(const std::vector<Vector3d>& places) {
  std::vector<Vector3d> displacement;
  for (const Vector3d& place : places) displacement.push_back(any_gradient() * place + Vector3d(1, -2, 0.5));
  return displacement;
}

} // namespace

TEST_CASE("an embedded surface reproduces a linear displacement inside and outside of distorted cells",
          "[verification]") {
  for (const double distortion : {0.0, 0.08})
    for (const double radius : {0.5, 0.9, 1.4, 4.0}) {
      CAPTURE(distortion, radius);
      const cases::Mesh mesh = body(distortion);
      const auto surface = mechanics::embed(sphere(radius, 9, 14), mesh);
      std::vector<Vector3d> moved;
      mechanics::move(surface, linear_displacement(mesh.nodes.to_vector()), moved);
      const std::vector<Vector3d> exact = linear_displacement(surface.rest.vertices);
      double largest = 0;
      for (std::size_t v = 0; v < moved.size(); ++v)
        largest = std::max(largest, (moved[v] - surface.rest.vertices[v] - exact[v]).norm());
      CHECK(largest <=
            1e-12 * radius + 1e-13); // rounding of sums of 8 terms, whose weights grow with distance
      if (radius > 3) CHECK(surface.n_outside == surface.vertices.size());
      if (radius < 0.6) CHECK(surface.n_outside == 0);
    }
}

TEST_CASE("a surface follows a bent body as its trilinear cells do", "[verification]") {
  const cases::Mesh mesh = body(0);
  std::vector<Vector3d> displacement; // x y z: in the space of trilinear cells along the axes
  for (const Vector3d& x : mesh.nodes) displacement.push_back({x.y() * x.z(), x.x() * x.y() * x.z(), x.x()});
  const auto surface = mechanics::embed(sphere(0.95, 8, 12), mesh);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const Vector3d& x = surface.rest.vertices[v];
    const Vector3d exact(x.y() * x.z(), x.x() * x.y() * x.z(), x.x());
    CHECK((mechanics::displacement_at(surface.vertices[v], displacement) - exact).norm() <= 1e-13);
  }
}

TEST_CASE("a point outside of a body is bound to the nearest point of its cells", "[verification]") {
  const cases::Mesh mesh = body(0);
  cases::TriangleMesh points;
  points.vertices = {{1.5, 0.1, 0.2}, {1.7, -1.3, 0.9}, {-3, 2, -1.1}, {0.2, 0.3, 0.1}};
  points.triangles = {{0, 1, 2}};
  const auto surface = mechanics::embed(points, mesh);
  CHECK(surface.n_outside == 3);
  const auto distance = [](const Vector3d& p) { return (p - p.cwiseMax(-1).cwiseMin(1)).norm(); };
  CHECK(surface.largest_distance == Approx(distance(points.vertices[2])).epsilon(1e-12));
  for (std::size_t v = 0; v < points.vertices.size(); ++v) {
    const Vector3d nearest = points.vertices[v].cwiseMax(-1).cwiseMin(1);
    const auto holding = cases::cells_at(mesh, nearest);
    const bool is_bound_there = std::any_of(holding.begin(), holding.end(), [&](std::size_t cell) {
      return mesh.cells[cell] == surface.vertices[v].nodes;
    });
    CHECK(is_bound_there);
    double sum = 0;
    for (const double weight : surface.vertices[v].weights) sum += weight;
    CHECK(sum == Approx(1).margin(1e-14));
  }
}

TEST_CASE("the outer surface of a box is closed, bound to its nodes and seen from outside") {
  const cases::Mesh mesh = body(0);
  const cases::TriangleMesh outer = cases::triangles_of_faces(mesh, cases::boundary_faces(mesh));
  CHECK(outer.vertices.size() == mesh.nodes.size() - 3 * 2 * 4);
  CHECK(outer.triangles.size() == 2 * 2 * (4 * 3 + 3 * 5 + 4 * 5));
  double volume = 0;
  for (const auto& triangle : outer.triangles)
    volume +=
        cases::doubled_area(triangle, outer.vertices).dot(cases::barycentre(triangle, outer.vertices)) / 6;
  CHECK(volume == Approx(8));
  const auto surface = mechanics::embed(outer, mesh);
  for (const auto& vertex : surface.vertices) {
    const auto largest = std::max_element(vertex.weights.begin(), vertex.weights.end());
    CHECK(*largest == Approx(1).margin(1e-12));
  }
}

TEST_CASE("weights of a patch add up to 1, and tend to its mean over the area as meshes are refined",
          "[verification]") {
  // The mean of (y - 5)² over a disc of radius 4 about the middle of a face, x = 10, is 4²/4.
  const Vector3d centre(10, 5, 5);
  double error_before = 0;
  for (const int n : {10, 40}) {
    const cases::Mesh mesh = cases::make_box_mesh({10, 10, 10}, {n, n, n});
    const auto weights = mechanics::patch_within(surface_of(mesh), centre, 4);
    CHECK(mean(weights, mesh, [](const Vector3d&) { return 1; }) == Approx(1).epsilon(1e-12)); // rounding
    CHECK(mean(weights, mesh, [](const Vector3d& at) { return at.x(); }) == Approx(10).epsilon(1e-12));
    const double error =
        std::abs(mean(weights, mesh, [](const Vector3d& at) { return std::pow(at.y() - 5, 2); }) - 4);
    if (n == 40) {
      CHECK(error < 0.05); // the value is 4: vertices a quarter of a millimetre apart sample a disc of 8
      CHECK(error < error_before);
    }
    error_before = error;
  }
}

TEST_CASE("a patch of no radius is its vertex, and where no vertex lies there is none") {
  const cases::Mesh mesh = cases::make_box_mesh({10, 10, 10}, {2, 2, 2});
  const mechanics::EmbeddedSurface surface = surface_of(mesh);
  const auto vertex = mechanics::patch_within(surface, {10, 5, 5}, 0);
  CHECK(mean(vertex, mesh, [](const Vector3d& at) { return (at - Vector3d(10, 5, 5)).norm(); }) < 1e-12);
  CHECK(mean(vertex, mesh, [](const Vector3d&) { return 1; }) == Approx(1).epsilon(1e-12));
  CHECK(mechanics::patch_within(surface, {10, 4, 5}, 0.5).empty());
  CHECK(mechanics::patch_within(surface, {10, std::nan(""), 5}, 3).empty());
}

TEST_CASE("vertices without triangles share a patch equally") {
  const cases::Mesh mesh = cases::make_box_mesh({10, 10, 10}, {1, 1, 1});
  const mechanics::EmbeddedSurface surface = mechanics::embed({{{0, 0, 0}, {10, 0, 0}}, {}}, mesh);
  const auto weights = mechanics::patch_within(surface, {5, 0, 0}, 5);
  CHECK(mean(weights, mesh, [](const Vector3d& at) { return at.x(); }) == Approx(5).epsilon(1e-12));
}
