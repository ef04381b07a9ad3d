#include "cases/mesh/read_mesh.hpp"

#include <catch2/catch.hpp>
#include <numeric>

using namespace springproof;

using namespace cases;
using Catch::Contains;
using Eigen::Vector3d;

// Other places checked for this defect: other sources of meshes (boxes, voxels, labels, cuts and their
// refinements are grids, with one node and one cell at most in each place; find_grid() refuses slits and
// doubles), group faces (refused unless they are a cell's), springs listed twice in a network
// (network_test.cpp), triangles of a surface (voxels_test.cpp).

namespace {

/// Cubes of one edge from a corner on, whose nodes are those that are there before.
void add_box(Mesh& mesh, const Vector3d& corner, double edge, const std::array<int, 3>& n = {1, 1, 1}) {
  const Mesh box = make_box_mesh(edge * Vector3d(n[0], n[1], n[2]), n);
  std::vector<int> numbers;
  for (const Vector3d& node : box.nodes) {
    const Vector3d at = corner + node;
    auto& nodes = mesh.nodes.stored();
    const auto found = std::find_if(nodes.begin(), nodes.end(),
                                    [&](const Vector3d& known) { return (known - at).norm() < 1e-12; });
    numbers.push_back(static_cast<int>(found - nodes.begin()));
    if (found == nodes.end()) nodes.push_back(at);
  }
  for (CellNodes cell : box.cells) {
    for (int& node : cell) node = numbers[index(node)];
    mesh.cells.stored().push_back(cell);
  }
}

/// Why a mesh is refused, its nodes and elements numbered from 1; empty: it is sound.
std::string reason(const Mesh& mesh) {
  MeshNumbers numbers{std::vector<std::size_t>(mesh.nodes.size()),
                      std::vector<std::size_t>(mesh.cells.size())};
  std::iota(numbers.of_nodes.begin(), numbers.of_nodes.end(), 1);
  std::iota(numbers.of_cells.begin(), numbers.of_cells.end(), 1);
  try {
    check_mesh(mesh, faces_of_cells(mesh), numbers);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

/// Gives cells' nodes of a plane, from y = 1 on, copies that other cells do not have.
void unmerge(Mesh& mesh, const std::vector<std::size_t>& cells, double x, const Vector3d& shift = {0, 0, 0}) {
  std::map<int, int> copies;
  for (const std::size_t cell : cells)
    for (int& node : mesh.cells.stored()[cell]) {
      const Vector3d at = mesh.nodes[index(node)];
      if (at.x() != x || at.y() < 1) continue;
      const auto [copy, is_new] = copies.try_emplace(node, static_cast<int>(mesh.nodes.size()));
      if (is_new) mesh.nodes.stored().emplace_back(at + shift);
      node = copy->second;
    }
}

} // namespace

TEST_CASE("a cell beside four of half its edge is refused by its face and a node that hangs there") {
  for (const double scale : {1., 1e-3, 1e3}) {
    Mesh mesh;
    add_box(mesh, {0, 0, 0}, 2);
    add_box(mesh, {2, 0, 0}, 1, {2, 2, 2});
    for (Vector3d& node : mesh.nodes.stored()) node *= scale;
    CHECK_THAT(reason(mesh),
               Contains(" lies on the face of nodes 2 4 8 6 of element 1, and is no vertex of it (5 nodes "
                        "are like that)"));
  }
  Mesh three; // nodes at thirds, on an edge and in the face
  add_box(three, {0, 0, 0}, 3);
  add_box(three, {3, 0, 0}, 1, {1, 3, 3});
  CHECK_THAT(reason(three), Contains("element 1") && Contains("(12 nodes are like that)"));
}

TEST_CASE("coordinates of single precision hide no hanging node, and a warped face none on it") {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, 2);
  add_box(mesh, {2, 0, 0}, 1, {2, 2, 2});
  for (Vector3d& node : mesh.nodes.stored()) {
    node = Vector3d(100, 100, 100) + node + 0.2 * node.y() * node.z() * Vector3d::UnitX();
    node = node.cast<float>().cast<double>();
  }
  CHECK_THAT(reason(mesh), Contains("(5 nodes are like that)"));
}

TEST_CASE(
    "a cell that is there twice, three at a face, and two on one side of it are refused by their numbers") {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, 1, {3, 2, 2});
  REQUIRE(reason(mesh).empty());
  Mesh twice = mesh;
  twice.cells.stored().push_back(mesh.cells[4]);
  CHECK_THAT(reason(twice), Contains("elements 5 and 13 are one hexahedron"));
  CellNodes turned = mesh.cells[4]; // the same cell, turned about z
  for (std::size_t v = 0; v < 8; ++v)
    turned[v] = mesh.cells[4][std::array<std::size_t, 8>{1, 3, 0, 2, 5, 7, 4, 6}[v]];
  twice.cells.stored().back() = turned;
  CHECK_THAT(reason(twice), Contains("elements 5 and 13 are one hexahedron"));

  Mesh other = mesh; // a cell on the first cell's face x+, with its own nodes beyond it
  CellNodes beyond = mesh.cells[1];
  for (const std::size_t v : {1u, 3u, 5u, 7u}) {
    other.nodes.stored().push_back(mesh.nodes[index(beyond[v])] + Vector3d(0.3, 0.1, 0.1));
    beyond[v] = static_cast<int>(other.nodes.size()) - 1;
  }
  other.cells.stored().push_back(beyond);
  CHECK_THAT(reason(other), Contains("belongs to elements 1, 2, 13, must belong to one or two"));

  Mesh pair;
  add_box(pair, {0, 0, 0}, 1);
  CellNodes inside = pair.cells[0]; // shares the face x- alone
  for (const std::size_t v : {1u, 3u, 5u, 7u}) {
    pair.nodes.stored().push_back(pair.nodes[index(inside[v])] - Vector3d(0.5, 0, 0));
    inside[v] = static_cast<int>(pair.nodes.size()) - 1;
  }
  pair.cells.stored().push_back(inside);
  CHECK_THAT(reason(pair),
             Contains("belongs to elements 1, 2, which lie on the same side of it and overlap"));
}

TEST_CASE("nodes that were not merged are refused, and a slit that is open is not") {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, 1, {2, 2, 1});
  Mesh closed = mesh;
  unmerge(closed, {1, 3}, 1);
  CHECK_THAT(reason(closed), Contains("in the place of node"));
  Mesh open = mesh;
  unmerge(open, {1, 3}, 1, {0.02, 0, 0});
  CHECK(reason(open).empty());
}

TEST_CASE("cells that run into each other away from their common nodes are refused") {
  Mesh mesh; // a ring of cells whose end has come into its beginning
  add_box(mesh, {0, 0, 0}, 1, {4, 1, 1});
  add_box(mesh, {3, 1, 0}, 1);
  add_box(mesh, {3, 2, 0}, 1);
  add_box(mesh, {2, 2, 0}, 1);
  REQUIRE(reason(mesh).empty());
  add_box(mesh, {1.2, 1.4, 0}, 0.5); // shares no node
  CHECK_THAT(reason(mesh), Contains("2 pieces that share no node"));
  CellNodes& last = mesh.cells.stored()[6]; // {2, 2, 0}: its lower left edge goes into cell 3
  for (const std::size_t v : {0u, 4u}) mesh.nodes.stored()[index(last[v])] += Vector3d(0.4, -1.6, 0);
  mesh.cells.stored().pop_back();
  mesh.nodes.stored().resize(mesh.nodes.size() - 8);
  CHECK_THAT(reason(mesh), Contains(" of element 3") || Contains("inverted"));
}

TEST_CASE("thin layers, graded, skewed and large meshes are sound") {
  Mesh layers;
  add_box(layers, {0, 0, 0}, 1, {4, 4, 4});
  for (Vector3d& node : layers.nodes.stored()) {
    node.z() = node.z() == 0 ? 0 : std::pow(1e-3, 4 - node.z()); // heights from 1e-9 to 1 mm
    node.x() += 0.7 * node.y();
  }
  CHECK(reason(layers).empty());
  Mesh large = make_box_mesh({50, 50, 50}, {50, 50, 50});
  large.grid.reset();
  CHECK(reason(large).empty());
}
