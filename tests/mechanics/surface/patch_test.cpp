#include "mechanics/surface/embedded_surface.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;

namespace {

mechanics::EmbeddedSurface surface_of(const cases::HexMesh& mesh) {
  return mechanics::embed(cases::outer_surface(mesh), mesh);
}

/// Sum over the nodes of a patch of weight times a function of their place.
template<class Function>
double mean(const std::vector<cases::WeightedPoint>& patch, const cases::HexMesh& mesh,
            const Function& function) {
  double sum = 0;
  for (const auto& [node, weight] : cases::on_nodes(patch, mesh))
    sum += weight * function(mesh.nodes[cases::index(node)]);
  return sum;
}

} // namespace

TEST_CASE("weights of a patch add up to 1, and tend to its mean over the area as meshes are refined",
          "[verification]") {
  // Over a disc of radius 4 about the middle of a face, x = 10, the mean of (y - 5)² is 4²/4.
  const Vector3d centre(10, 5, 5);
  double error_before = 0;
  for (const int n : {10, 40}) {
    const cases::HexMesh mesh = cases::make_box_mesh({10, 10, 10}, {n, n, n});
    const auto weights = mechanics::patch_within(surface_of(mesh), centre, 4);
    CHECK(mean(weights, mesh, [](const Vector3d&) { return 1; }) == Approx(1).epsilon(1e-12)); // rounding
    CHECK(mean(weights, mesh, [](const Vector3d& at) { return at.x(); }) == Approx(10).epsilon(1e-12));
    const double error =
        std::abs(mean(weights, mesh, [](const Vector3d& at) { return std::pow(at.y() - 5, 2); }) - 4);
    if (n == 40) {
      CHECK(error < 0.05); // of 4: vertices a quarter of a millimetre apart sample a disc of 8
      CHECK(error < error_before);
    }
    error_before = error;
  }
}

TEST_CASE("a patch of no radius is its vertex, and where no vertex lies there is none") {
  const cases::HexMesh mesh = cases::make_box_mesh({10, 10, 10}, {2, 2, 2});
  const mechanics::EmbeddedSurface surface = surface_of(mesh);
  const auto vertex = mechanics::patch_within(surface, {10, 5, 5}, 0);
  CHECK(mean(vertex, mesh, [](const Vector3d& at) { return (at - Vector3d(10, 5, 5)).norm(); }) < 1e-12);
  CHECK(mean(vertex, mesh, [](const Vector3d&) { return 1; }) == Approx(1).epsilon(1e-12));
  CHECK(mechanics::patch_within(surface, {10, 4, 5}, 0.5).empty());
  CHECK(mechanics::patch_within(surface, {10, std::nan(""), 5}, 3).empty());
}

TEST_CASE("vertices without triangles share a patch equally") {
  const cases::HexMesh mesh = cases::make_box_mesh({10, 10, 10}, {1, 1, 1});
  const mechanics::EmbeddedSurface surface = mechanics::embed({{{0, 0, 0}, {10, 0, 0}}, {}}, mesh);
  const auto weights = mechanics::patch_within(surface, {5, 0, 0}, 5);
  CHECK(mean(weights, mesh, [](const Vector3d& at) { return at.x(); }) == Approx(5).epsilon(1e-12));
}
