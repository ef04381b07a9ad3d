#include "cases/mesh/mesh.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

using namespace springproof;

using namespace cases;
using Eigen::Vector3d;

namespace {

constexpr double rounding = 1e-13; ///< relative; a few operations on numbers of order 1 to 100

CellCorners unit_cube() {
  CellCorners vertices(8);
  for (int v = 0; v < 8; ++v) vertices[static_cast<std::size_t>(v)] = Vector3d(v & 1, (v >> 1) & 1, v >> 2);
  return vertices;
}

double total_volume(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) volume += cell_volume(cell_corners(mesh, c));
  return volume;
}

Grid l_shape() {
  Grid grid;
  grid.cells = {2, 1, 2};
  grid.present = {true, true, true, false}; // two cells below, one above
  return grid;
}

} // namespace

TEST_CASE("a cropped grid has the same mesh without the empty layers around it") {
  Grid grid;
  grid.cells = {5, 4, 6};
  grid.spacing = {1, 2, 0.5};
  grid.origin = {-1, 3, 7};
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i)
        grid.present.push_back(i >= 1 && i < 4 && j < 3 && k >= 2 && (i + j + k) % 5 != 0);
  const Grid part = cropped(grid);
  CHECK(part.cells == std::array<int, 3>{3, 3, 4});
  const Mesh whole = make_grid_mesh(grid), mesh = make_grid_mesh(part);
  REQUIRE(mesh.cells.size() == whole.cells.size());
  REQUIRE(mesh.nodes.size() == whole.nodes.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) CHECK(mesh.cells[c] == whole.cells[c]);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) CHECK((mesh.nodes[n] - whole.nodes[n]).norm() <= 1e-14);
  grid.present.assign(grid.present.size(), false);
  CHECK(cropped(grid).cells == grid.cells);
}

TEST_CASE("a box has its nodes with x running fastest, and its far faces exactly at its size") {
  const Mesh mesh = make_box_mesh({0.3, 0.7, 1.1}, {3, 7, 11});
  REQUIRE(mesh.nodes.size() == 4 * 8 * 12);
  REQUIRE(mesh.cells.size() == 3 * 7 * 11);
  CHECK(mesh.nodes[1].y() == 0);
  CHECK(mesh.nodes.back() == Vector3d(0.3, 0.7, 1.1));
  CHECK(total_volume(mesh) == Approx(0.3 * 0.7 * 1.1).epsilon(rounding));
}

TEST_CASE(
    "nodes and cells of a whole grid follow from their numbers, and are those that a mask would store") {
  Grid grid{{3, 2, 4}, {0.1, 0.7, 1.1}, {-1, 1e-3, 7}, {}};
  Mesh ruled = make_grid_mesh(grid);
  grid.present.assign(3 * 2 * 4, true);
  const Mesh stored = make_grid_mesh(grid);
  CHECK(ruled.nodes.values.empty());
  CHECK(ruled.cells.values.empty());
  CHECK(ruled.nodes.size() == stored.nodes.size());
  CHECK(ruled.nodes.to_vector() == stored.nodes.values); // equal to the last bit
  CHECK(ruled.cells.to_vector() == stored.cells.values);
  ruled.nodes.stored()[5].x() = 3;
  CHECK(ruled.nodes[5].x() == 3);
  CHECK(ruled.nodes[6] == stored.nodes[6]);
  CHECK(ruled.nodes.size() == stored.nodes.size());
}

TEST_CASE("a masked grid has the present cells, and nodes that they touch alone") {
  const Mesh mesh = make_grid_mesh(l_shape());
  CHECK(mesh.cells.size() == 3);
  CHECK(mesh.nodes.size() == 18 - 2); // the edge at x = 2, z = 2 belongs to the missing cell alone
  CHECK(total_volume(mesh) == Approx(3).epsilon(rounding));
  CHECK(boundary_faces(mesh).size() == 14); // an L of three cubes
}

TEST_CASE("the surface of a grid, found from its cells' neighbours, is the one found by counting faces") {
  Grid holes{{5, 4, 6}, {1, 2, 3}, {0, 0, 0}, {}};
  for (std::size_t c = 0; c < holes.n_lattice_cells(); ++c)
    holes.present.push_back(c % 7 != 3 && c % 11 != 5);
  for (Mesh mesh : {make_grid_mesh(holes), make_box_mesh({5, 8, 18}, {5, 4, 6})}) {
    const auto by_neighbours = boundary_faces(mesh);
    mesh.grid.reset();
    CHECK(by_neighbours == boundary_faces(mesh));
  }
}

TEST_CASE("the springs of a cell are 12 edges, 12 face diagonals and 4 internal diagonals of lengths 1, sqrt "
          "2 and sqrt 3") {
  const auto x = unit_cube();
  std::set<std::pair<int, int>> pairs;
  const auto check = [&](const auto& list, double length_squared) {
    for (const auto& [a, b] : list) {
      CHECK((x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)]).squaredNorm() ==
            length_squared);
      pairs.insert(std::minmax(a, b));
    }
  };
  check(cell_edges, 1);
  check(cell_face_diagonals, 2);
  check(cell_internal_diagonals, 3);
  CHECK(pairs.size() == 28); // every pair of eight vertices, once
}

TEST_CASE("the faces of a cell turn anticlockwise seen from outside") {
  const auto x = unit_cube();
  for (const auto& face : cell_faces) {
    const auto at = [&](std::size_t v) { return x[static_cast<std::size_t>(face[v])]; };
    const Vector3d normal = (at(1) - at(0)).cross(at(3) - at(0));
    const Vector3d outwards = (at(0) + at(2)) / 2 - Vector3d(0.5, 0.5, 0.5);
    CHECK(normal.dot(outwards) == Approx(0.5).epsilon(rounding));
  }
}

TEST_CASE("the volume of a hexahedron is exact under any affine map, and negative inside out") {
  Eigen::Matrix3d map;
  map << 1.2, 0.3, -0.1, 0.4, 0.9, 0.2, -0.3, 0.1, 1.5;
  auto x = unit_cube();
  for (Vector3d& vertex : x) vertex = map * vertex;
  CHECK(cell_volume(x) == Approx(map.determinant()).epsilon(rounding));
  CHECK(smallest_corner_jacobian(x) == Approx(map.determinant()).epsilon(rounding));
  for (Vector3d& vertex : x) vertex.z() *= -1;
  CHECK(cell_volume(x) == Approx(-map.determinant()).epsilon(rounding));
}

TEST_CASE(
    "one corner pushed through the cell shows in its corner Jacobian while the volume is still positive") {
  auto x = unit_cube();
  x[7] = Vector3d(0.2, 0.2, 0.2);
  CHECK(cell_volume(x) > 0);
  CHECK(smallest_corner_jacobian(x) < 0);
}

TEST_CASE("refinement keeps the body, the numbers of its nodes and the parentage of its cells") {
  Mesh mesh = make_grid_mesh(l_shape());
  mesh.nodes.stored()[5] += Vector3d(0.1, -0.05, 0.08); // no longer a box of planes
  const Mesh fine = refine(mesh);
  CHECK(fine.cells.size() == 8 * mesh.cells.size());
  CHECK(total_volume(fine) == Approx(total_volume(mesh)).epsilon(rounding));
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n) CHECK(fine.nodes[n] == mesh.nodes[n]);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    double children = 0;
    for (std::size_t child = 8 * c; child < 8 * c + 8; ++child) {
      children += cell_volume(cell_corners(fine, child));
      CHECK(smallest_corner_jacobian(cell_corners(fine, child)) > 0);
    }
    CHECK(children == Approx(cell_volume(cell_corners(mesh, c))).epsilon(rounding));
  }
  CHECK(boundary_faces(fine).size() == 4 * boundary_faces(mesh).size());
}

TEST_CASE("refinement splits the faces and edges of groups and adds their midpoints") {
  Mesh mesh = make_box_mesh({1, 1, 1}, {1, 1, 1});
  mesh.groups["top"] = {{4, 5, 6, 7}, {{4, 5}, {5, 7}, {6, 7}, {4, 6}}, {{4, 5, 7, 6}}};
  const Selection top = refine(mesh).groups.at("top");
  CHECK(top.nodes.size() == 9);
  CHECK(top.faces.size() == 4);
  CHECK(top.edges.size() == 12);
}
