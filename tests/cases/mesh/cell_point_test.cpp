#include "cases/mesh/cell_point.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;
using Cells = std::vector<std::size_t>;

TEST_CASE("a point is found in its cell, on a face in both, at a vertex in all, outside in none") {
  const Mesh mesh = make_box_mesh({2, 2, 2}, {2, 2, 2});
  CHECK(cells_at(mesh, {0.5, 0.5, 0.5}) == Cells{0});
  CHECK(cells_at(mesh, {1.2, 0.3, 1.9}) == Cells{5});
  CHECK(cells_at(mesh, {1, 0.3, 1.9}) == Cells{4, 5});
  CHECK(cells_at(mesh, {1 + 1e-7, 0.3, 1.9}) == Cells{4, 5}); // the edge is within 1e-6
  CHECK(cells_at(mesh, {1 + 1e-5, 0.3, 1.9}) == Cells{5});
  CHECK(cells_at(mesh, {1, 1, 1}).size() == 8);
  CHECK(cells_at(mesh, {2, 2, 2}) == Cells{7});
  CHECK(cells_at(mesh, {2.001, 1, 1}).empty());
  CHECK(cells_at(mesh, {-50, 1, 1}).empty());
}

TEST_CASE("a box whose cells follow from numbers and the same mesh, stored, have the same cells at a point") {
  const Mesh box = make_box_mesh({3, 5, 2}, {4, 5, 3});
  Mesh stored = box;
  stored.nodes.stored();
  REQUIRE(box.nodes.rule);
  REQUIRE_FALSE(stored.nodes.rule);
  for (const double x : {-1., 0., 0.3, 0.75, 1.5, 2.9999999, 3., 1e300})
    for (const double y : {-1e-9, 2., 4.5, 5.1})
      for (const double z : {0.1, 2. / 3, 2.}) {
        CAPTURE(x, y, z);
        CHECK(cells_at(box, {x, y, z}) == cells_at(stored, {x, y, z}));
        CHECK(cells_at(box, {x, y, z}, {7, 30}) == cells_at(stored, {x, y, z}, {7, 30}));
      }
}

TEST_CASE("every point of distorted cells is in the cell that its map takes it to", "[verification]") {
  Mesh mesh = make_box_mesh({3, 3, 3}, {3, 3, 3});
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) {
    const auto k = static_cast<double>(n);
    mesh.nodes.stored()[n] += 0.2 * Vector3d(std::sin(12.9 * k), std::sin(78.2 * k), std::sin(37.7 * k));
  }
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const Vector3d& at :
         {Vector3d(0.5, 0.5, 0.5), Vector3d(0.03, 0.9, 0.4), Vector3d(0.98, 0.97, 0.02)}) {
      Vector3d point = Vector3d::Zero();
      const auto vertices = cell_vertices(mesh, c);
      for (int v = 0; v < 8; ++v) {
        double shape = 1;
        for (int a = 0; a < 3; ++a) shape *= (v >> a) & 1 ? at[a] : 1 - at[a];
        point += shape * vertices[index(v)];
      }
      CAPTURE(c, at.transpose());
      CHECK(cells_at(mesh, point) == Cells{c});
    }
}
