#include "cases/scene/loads.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

/// Returns a case whose body is a box of 1 mm cubes.
Case cubes(const std::array<int, 3>& cells) {
  Case definition;
  definition.body = Box{Vector3d(cells[0], cells[1], cells[2]), cells};
  return definition;
}

/// Points in and beside the cells of a body, whose weights add up to 1.
std::vector<WeightedPoint> points_of(const Mesh& mesh, double farthest_beyond) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> in_cell(0, 1), beside(-farthest_beyond, farthest_beyond);
  std::vector<WeightedPoint> points;
  double whole = 0;
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell) {
    CellPoint point{cell, Vector3d::Zero(), Vector3d::Zero()};
    for (int axis = 0; axis < 3; ++axis) {
      point.at[axis] = in_cell(generator);
      point.beyond[axis] = beside(generator);
    }
    whole += points.emplace_back(WeightedPoint{point, in_cell(generator)}).weight;
  }
  for (WeightedPoint& point : points) point.weight /= whole;
  return points;
}

Scene pulled(Scene scene, const std::vector<WeightedPoint>& points, const Vector3d& force) {
  Scene::AppliedLoad patch;
  patch.points = points;
  patch.load.kind = loads::NodalForce{force};
  give_to_nodes(patch, scene.mesh, modelled_share(scene));
  scene.loads = {patch};
  return scene;
}

/// Work of the load on a vector field (mm), from the forces on the nodes.
template<class Field>
double work(const Scene& scene, const Field& field) {
  double sum = 0;
  for (const auto& [node, force] : loaded_nodes(scene))
    sum += force.dot(field(scene.mesh.nodes[index(node)]));
  return sum;
}

} // namespace

TEST_CASE("a patch has the same force and moment, and does the same work in linear fields, on finer meshes",
          "[verification]") {
  Scene scene = make_scene(cubes({2, 3, 2}));
  for (Vector3d& node : scene.mesh.nodes.stored()) // cells of any shape
    node += 0.1 * Vector3d(std::sin(7 * node.y()), std::sin(5 * node.z()), std::sin(3 * node.x() * node.y()));
  const Scene coarse = pulled(scene, points_of(scene.mesh, 0.5), {1, -2, 3});
  Eigen::Matrix3d gradient;
  gradient << 1, 2, 3, -4, 5, 6, 7, -8, 9;
  for (const int n : {1, 2}) {
    const Scene fine = refine(coarse, n);
    CHECK(loaded_nodes(fine).size() > loaded_nodes(coarse).size());
    for (int axis = 0; axis < 3; ++axis) {
      const auto along = [&](const Vector3d&) -> Vector3d { return Vector3d::Unit(axis); };
      const auto about = [&](const Vector3d& at) -> Vector3d { return Vector3d::Unit(axis).cross(at); };
      CHECK(work(fine, along) == Approx(Vector3d(1, -2, 3)[axis]).epsilon(1e-12)); // rounding
      CHECK(work(fine, about) == Approx(work(coarse, about)).epsilon(1e-12));
    }
    const auto linear = [&](const Vector3d& at) -> Vector3d { return gradient * at; };
    CHECK(work(fine, linear) == Approx(work(coarse, linear)).epsilon(1e-12));
  }
}

TEST_CASE("a patch's work in a quadratic field is that at its points, to what its own cells interpolate",
          "[verification]") {
  const Scene scene = make_scene(cubes({2, 3, 2}));
  const auto points = points_of(scene.mesh, 0);
  const Scene coarse = pulled(scene, points, {1, 0, 0});
  const auto square = [](const Vector3d& at) { return Vector3d(at.x() * at.x(), 0, 0); };
  double exact = 0; // N mm
  for (const auto& [point, weight] : points)
    exact +=
        weight * std::pow(scene.mesh.nodes[index(scene.mesh.cells[point.cell][0])].x() + point.at.x(), 2);
  // Interpolation of x² in a cell from a to b errs by (b - x)(x - a), a quarter of h² at most.
  CHECK(work(coarse, square) - exact > 0.25 / 4); // mm²: nodes of the coarse cells are too far off
  CHECK(work(refine(coarse, 1), square) - exact <= 0.25 / 4);
  CHECK(work(refine(coarse, 2), square) - exact <= 0.25 / 16);
  CHECK(work(refine(coarse, 2), square) >= exact);
}

TEST_CASE("a patch on a plane of symmetry is all on the modelled part, on finer meshes too") {
  Case definition = cubes({2, 2, 2});
  definition.symmetry.resize(1);
  definition.symmetry[0].region.name = "x-";
  definition.symmetry[0].components = {true, false, false};
  const Scene scene = make_scene(definition);
  const std::vector<WeightedPoint> points{{{0, {0, 0.3, 0.6}, {0, 0, 0}}, 0.4},
                                          {{0, {0.8, 1, 0.6}, {0, 0, 0}}, 0.6}};
  const Scene coarse = pulled(scene, points, {0, 0, 2});
  for (const int n : {0, 1, 2})
    CHECK(work(refine(coarse, n), [](const Vector3d&) { return Vector3d::UnitZ(); }) ==
          Approx(2).epsilon(1e-12)); // rounding
}
