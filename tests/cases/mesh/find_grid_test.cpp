#include "cases/mesh/mesh.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>

using namespace springproof;

using namespace cases;

namespace {

/// The same body with nodes and cells in another order and every cell turned about the z axis by a quarter:
/// i' = j, j' = 1 - i.
Mesh shuffled(const Mesh& mesh) {
  std::mt19937 random(1);
  std::vector<int> place(mesh.nodes.size());
  for (std::size_t n = 0; n < place.size(); ++n) place[n] = static_cast<int>(n);
  std::shuffle(place.begin(), place.end(), random);
  Mesh other;
  other.nodes.stored().resize(mesh.nodes.size());
  for (std::size_t n = 0; n < place.size(); ++n)
    other.nodes.stored()[static_cast<std::size_t>(place[n])] = mesh.nodes[n];
  for (const auto& cell : mesh.cells) {
    CellNodes turned(8, 0);
    for (std::size_t v = 0; v < 8; ++v) {
      const std::size_t i = v & 1, j = (v >> 1) & 1, k = v >> 2;
      turned[j + 2 * (1 - i) + 4 * k] = place[static_cast<std::size_t>(cell[v])];
    }
    other.cells.stored().push_back(turned);
  }
  std::shuffle(other.cells.stored().begin(), other.cells.stored().end(), random);
  return other;
}

Grid l_shape_at_a_distance() {
  Grid grid;
  grid.cells = {3, 2, 2};
  grid.spacing = {1, 0.5, 0.3};
  grid.origin = {-1, 2, 0.1};
  grid.present = {true, false, true, true, true, true, true, false, false, true, false, false};
  return grid;
}

} // namespace

TEST_CASE("a grid is found again however its cells are numbered and turned") {
  for (const Grid& grid : {l_shape_at_a_distance(), Grid{{2, 3, 4}, {0.1, 0.1, 0.1}, {0, 0, 0}, {}}}) {
    const Mesh original = make_grid_mesh(grid);
    Mesh mesh = shuffled(original);
    REQUIRE(find_grid(mesh));
    CHECK(mesh.grid->cells == grid.cells);
    CHECK(mesh.grid->spacing.isApprox(grid.spacing, 1e-14)); // a few rounding errors of the coordinates
    CHECK(mesh.grid->origin.isApprox(grid.origin, 1e-14));
    CHECK(mesh.grid->present == grid.present);
    REQUIRE(mesh.cells.size() == original.cells.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      for (std::size_t v = 0; v < 8; ++v) CHECK(cell_vertices(mesh, c)[v] == cell_vertices(original, c)[v]);
  }
}

TEST_CASE("groups follow their cells into the grid's order") {
  Mesh mesh = make_box_mesh({3, 1, 1}, {3, 1, 1});
  mesh.grid.reset();
  std::swap(mesh.cells.stored()[0], mesh.cells.stored()[2]);
  mesh.group_of_cell = {"right", "middle", "left"};
  REQUIRE(find_grid(mesh));
  CHECK(mesh.group_of_cell == std::vector<std::string>{"left", "middle", "right"});
}

TEST_CASE("cells that are unequal, distorted or off the axes are no grid") {
  const Mesh box = make_box_mesh({2, 2, 2}, {2, 2, 2});
  Mesh unequal = box, distorted = box, turned = box;
  for (auto& node : unequal.nodes.stored())
    if (node.x() == 1) node.x() = 0.9;
  distorted.nodes.stored()[13].z() += 1e-6;
  for (auto& node : turned.nodes.stored())
    node = {0.8 * node.x() - 0.6 * node.y(), 0.6 * node.x() + 0.8 * node.y(), node.z()};
  for (Mesh mesh : {unequal, distorted, turned}) {
    mesh.grid.reset();
    CHECK_FALSE(find_grid(mesh));
    CHECK_FALSE(mesh.grid.has_value());
  }
}

TEST_CASE("a body with a slit is no grid, which would close it") {
  Mesh mesh = make_box_mesh({2, 2, 2}, {2, 2, 2});
  mesh.grid.reset();
  Mesh slit = mesh;
  const auto n = static_cast<int>(mesh.nodes.size());
  for (const int node : {9, 12, 15}) slit.nodes.stored().push_back(mesh.nodes[index(node)]); // x = 0, z = 1
  for (std::size_t c = 4; c < 8; ++c)                                                        // those above
    for (int& node : slit.cells.stored()[c])
      if (node == 9 || node == 12 || node == 15) node = n + (node - 9) / 3;
  CHECK(find_grid(mesh));
  CHECK_FALSE(find_grid(slit));
  CHECK(boundary_faces(slit).size() == 24 + 4); // the body's, and the slit's two sides
}

TEST_CASE("a chain of cells along a diagonal is no grid: its lattice would fill the memory") {
  Mesh mesh;
  constexpr int n = 1000; // steps in each direction: a lattice of 10⁹ places
  for (int i = 0; i < n; ++i) {
    const Mesh cell = make_grid_mesh({{1, 1, 1}, {1, 1, 1}, Eigen::Vector3d::Constant(i), {}});
    auto& vertices = mesh.cells.stored().emplace_back(cell.cells[0]);
    for (int& vertex : vertices) vertex += static_cast<int>(mesh.nodes.size());
    for (const Eigen::Vector3d& node : cell.nodes) mesh.nodes.stored().push_back(node);
  }
  CHECK_FALSE(find_grid(mesh));
}
