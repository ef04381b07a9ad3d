#include "cases/scene/thickness.hpp"

#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

std::vector<int> across(const cases::Mesh& mesh, const std::vector<std::string>& planes = {}) {
  std::vector<cases::Fixed> symmetry;
  for (const std::string& plane : planes) symmetry.push_back({bodies::region(plane)});
  return cases::cells_across(mesh, symmetry, 8);
}

/// The same cells in a mesh that is no grid: every second one seen from another side.
cases::Mesh as_hexahedra(const cases::Mesh& grid) {
  cases::Mesh mesh;
  mesh.nodes = grid.nodes.to_vector();
  std::vector<cases::CellNodes> cells = grid.cells.to_vector();
  for (std::size_t c = 0; c < cells.size(); c += 2) // x to y, y to z, z to x
    cells[c] = cases::pick(cells[c], cases::CellNodes{0, 2, 4, 6, 1, 3, 5, 7});
  mesh.cells = cells;
  return mesh;
}

} // namespace

TEST_CASE("a box is as many cells across as its least number, at most so many as asked") {
  for (const int n : across(cases::make_box_mesh({10, 3, 4}, {10, 3, 4}))) CHECK(n == 3);
  for (const int n : across(cases::make_box_mesh({10, 10, 12}, {10, 10, 12}))) CHECK(n == 8);
}

TEST_CASE("a plane of symmetry mirrors what is across it, and two make a body without end") {
  for (const int n : across(cases::make_box_mesh({10, 3, 4}, {10, 3, 4}), {"y-"})) CHECK(n == 4);
  for (const int n : across(cases::make_box_mesh({6, 1, 6}, {6, 1, 6}), {"y-", "y+"})) CHECK(n == 6);
}

TEST_CASE("a fin on a block is thin, the block is not, in a grid and in a mesh of hexahedra") {
  cases::Grid grid;
  grid.cells = {4, 4, 7};
  for (int k = 0; k < 7; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) grid.present.push_back(k < 4 || j == 1);
  const cases::Mesh mesh = cases::make_grid_mesh(grid);
  const std::vector<int> n = across(mesh);
  REQUIRE(n.size() == 4 * 4 * 4 + 3 * 4);
  for (std::size_t c = 0; c < n.size(); ++c) CHECK(n[c] == (c < 64 ? 4 : 1));
  CHECK(across(as_hexahedra(mesh)) == n);
}
