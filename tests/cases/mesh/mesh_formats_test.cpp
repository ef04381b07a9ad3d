#include "cases/mesh/read_mesh.hpp"
#include "tests/support/mesh_volume.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <set>

using namespace springproof;

using namespace cases;
using Catch::Contains;
using Eigen::Vector3d;
namespace fs = std::filesystem;

namespace {

/// Files of one body that other programs have written (its README.md says how).
const fs::path files = fs::path(SPRINGPROOF_SOURCE_DIR) / "tests/cases/mesh/files";

Mesh read_file(const std::string& name, std::vector<std::string>* remarks = nullptr,
               const std::string& groups = "") {
  return read_mesh({{(files / name).string(), {}}, 1, groups}, remarks);
}

/// Tetrahedra of a cube around its diagonal, nodes and elements numbered from 1.
const std::vector<std::array<int, 4>> in_cube{{1, 2, 3, 7}, {1, 3, 4, 7}, {1, 4, 8, 7},
                                              {1, 8, 5, 7}, {1, 5, 6, 7}, {1, 6, 2, 7}};
const char* const cube_nodes = "1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n";

/// A .msh of format 2.2.  @param elements  "number type n_tags group entity nodes"
std::string msh_22(const std::vector<std::string>& elements, const std::string& nodes = cube_nodes,
                   int n_nodes = 8) {
  return fmt::format(
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{}$EndNodes\n$Elements\n{}\n{}\n$EndElements\n",
      n_nodes, nodes, elements.size(), fmt::join(elements, "\n"));
}

std::vector<std::string> as_tetrahedra(const std::vector<std::array<int, 4>>& cells) {
  std::vector<std::string> elements;
  for (const auto& cell : cells)
    elements.push_back(fmt::format("{} 4 2 0 1 {}", elements.size() + 1, fmt::join(cell, " ")));
  return elements;
}

Mesh mesh_of_text(const std::string& name, const std::string& text,
                  std::vector<std::string>* remarks = nullptr) {
  const TemporaryFolder folder;
  return read_mesh({{folder.write(name, text), {"case.toml", 6, 8, "body.file"}}}, remarks);
}

/// Checks that a file is refused in one line.
void check_is_refused(const std::string& name, const std::string& text, const std::string& reason) {
  INFO(reason);
  try {
    mesh_of_text(name, text);
    FAIL("was read");
  } catch (const InputError& error) {
    CHECK_THAT(error.what(), Catch::StartsWith("case.toml:6:8: body.file: ") && Contains(reason));
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
  }
}

} // namespace

TEST_CASE("tetrahedra that gmsh has written in any format are one body, with groups of cells and faces") {
  for (const char* name : {"gmsh_22_text.msh", "gmsh_22_binary.msh", "gmsh_41_text.msh", "gmsh_41_binary.msh",
                           "meshio_22.msh", "gmsh_quadratic.msh", "block.geo"}) {
    INFO(name);
    std::vector<std::string> remarks;
    const Mesh mesh = read_file(name, &remarks);
    CHECK(mesh.shape == CellShape::tetrahedron);
    CHECK(mesh.cells.size() == 48);
    CHECK(mesh.nodes.size() == 23);
    CHECK(volume_of(mesh) == Approx(2).epsilon(1e-12)); // rounding
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      CHECK(mesh.group_of_cell.at(c) == (centre_of(mesh, mesh.cells[c]).x() < 1 ? "soft" : "hard"));
    CHECK(mesh.groups.at("left").faces.size() == 4);
    CHECK(mesh.groups.at("right").faces.size() == 4);
    CHECK(mesh.groups.at("right").nodes.size() == 5);
    for (const int node : mesh.groups.at("right").nodes) CHECK(mesh.nodes[index(node)].x() == 2);
    CHECK(remarks.size() == (std::string(name) == "gmsh_quadratic.msh" ? 1 : 0));
    if (!remarks.empty())
      CHECK_THAT(remarks[0],
                 Contains("gmsh_quadratic.msh: 48 of its 48 tetrahedra have nodes between their corners"));
  }
}

TEST_CASE("tetrahedra of meshio's and VTK's writers have whole numbers of their cells as groups") {
  for (const char* name : {"meshio.vtu", "meshio.vtk", "meshio_quadratic.vtu"}) {
    INFO(name);
    std::vector<std::string> remarks;
    const Mesh mesh = read_file(name, &remarks);
    CHECK(mesh.cells.size() == 48);
    CHECK(volume_of(mesh) == Approx(2).epsilon(1e-12)); // rounding
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      CHECK(mesh.group_of_cell.at(c) == (centre_of(mesh, mesh.cells[c]).x() < 1 ? "1" : "2"));
    CHECK(mesh.groups.at("3").faces.size() == 4);
    CHECK(mesh.groups.at("4").faces.size() == 4);
    CHECK_THAT(remarks.at(0), Contains("groups are named by the values of 'gmsh:physical' of its cells"));
    const Mesh by_name = read_file(name, nullptr, "gmsh:geometrical");
    CHECK(by_name.groups.at("7").faces.size() == 4); // the right surface's number
  }
  for (const char* name : {"gmsh_text.vtk", "gmsh_binary.vtk", "vtk.vtu", "vtk.vtk"}) {
    INFO(name);
    const Mesh mesh = read_file(name);
    CHECK(mesh.cells.size() == 48);
    CHECK(volume_of(mesh) == Approx(2).epsilon(1e-12)); // rounding
    CHECK(mesh.groups.at("4").faces.size() == 4);
    CHECK(std::set<std::string>(mesh.group_of_cell.begin(), mesh.group_of_cell.end()).size() == 2);
  }
  for (const char* name : {"meshio_41.msh", "meshio_22_plain.msh"}) {
    const Mesh mesh = read_file(name);
    CHECK(mesh.cells.size() == 48);
    CHECK(mesh.groups.empty());
  }
  CHECK_THROWS_WITH(read_file("meshio.vtu", nullptr, "zone"),
                    Contains("has no whole number 'zone' of each cell") && Contains("'gmsh:physical'"));
}

TEST_CASE("every element of a file of format 2 has its own group, whatever its entity") {
  std::vector<std::string> elements = as_tetrahedra(in_cube);
  elements[0] = "1 4 2 7 1 1 2 3 7";
  elements.push_back("7 2 2 3 1 1 2 3");
  elements.push_back("8 2 2 4 1 5 6 7");
  const Mesh mesh = mesh_of_text("a.msh", msh_22(elements));
  CHECK(mesh.group_of_cell == std::vector<std::string>{"", "", "", "", "", "7"});
  CHECK(mesh.groups.at("3").faces.size() == 1);
  CHECK(mesh.groups.at("4").faces.size() == 1);
  check_is_refused("a.msh", msh_22({"1 4 2 7 1 1 2 3 7", "2 2 2 3 1 5 6 8"}),
                   "element 2 of group '3' is no face");
}

TEST_CASE("a cell of several groups is one cell, and the smallest of them has it") {
  // gmsh lists such elements once for each group in format 2.
  std::vector<std::string> elements;
  for (int n = 0; n < 6; ++n)
    elements.push_back(fmt::format("{} 4 2 9 1 {}", n + 1, fmt::join(in_cube[std::size_t(n)], " ")));
  for (int n = 0; n < 2; ++n)
    elements.push_back(fmt::format("{} 4 2 10 1 {}", n + 7, fmt::join(in_cube[std::size_t(n)], " ")));
  std::vector<std::string> remarks;
  const Mesh mesh = mesh_of_text("a.msh", msh_22(elements), &remarks);
  CHECK(mesh.cells.size() == 6);
  CHECK(mesh.group_of_cell == std::vector<std::string>{"10", "10", "9", "9", "9", "9"});
  CHECK(mesh.groups.at("9").nodes.size() == 8);
  CHECK_THAT(remarks.at(0), Contains("2 tetrahedra are in several groups of cells"));
  elements.push_back("9 4 2 9 1 1 2 3 7"); // twice in one group
  check_is_refused("a.msh", msh_22(elements), "elements 1 and 9 are one tetrahedron");
}

TEST_CASE("tetrahedra that are all inside out are turned, and some of them are refused with their numbers") {
  auto turned = in_cube;
  for (auto& cell : turned) std::swap(cell[0], cell[1]);
  std::vector<std::string> remarks;
  const Mesh mesh = mesh_of_text("a.msh", msh_22(as_tetrahedra(turned)), &remarks);
  CHECK(volume_of(mesh) == Approx(1));
  CHECK_THAT(remarks.at(0), Contains("all of its 6 tetrahedra are inside out, and are turned"));
  turned[3] = in_cube[3];
  check_is_refused("a.msh", msh_22(as_tetrahedra(turned)), "5 of 6 tetrahedra are inverted or degenerate");
}

TEST_CASE("cells of several shapes, or of none that a mesh can have, are refused by their names") {
  std::vector<std::string> mixed = as_tetrahedra(in_cube);
  mixed.push_back("7 6 2 0 1 1 2 3 5 6 7");
  check_is_refused("a.msh", msh_22(mixed),
                   "has 6 tetrahedra and 1 wedge, must have hexahedra alone or tetrahedra alone");
  mixed.push_back("8 5 2 0 1 1 2 3 4 5 6 7 8");
  mixed.push_back("9 7 2 0 1 1 2 3 4 5");
  check_is_refused("a.msh", msh_22(mixed), "has 6 tetrahedra, 1 hexahedron, 1 wedge and 1 pyramid");
  check_is_refused("a.msh", msh_22({"1 6 2 0 1 1 2 3 5 6 7"}), "has 1 wedge, must have");
  check_is_refused("a.msh", msh_22({"1 2 2 0 1 1 2 3"}),
                   "a closed surface in STL, OBJ, PLY or VTP is a body of shape");
  check_is_refused("a.msh", "(1 \"meshio 5.0.0\")\n", "meshio");
  check_is_refused("a.msh", "$MeshFormat\n3 0 8\n$EndMeshFormat\n", "has format 3");
  const std::string vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
                          "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  check_is_refused("a.vtk", vtk + "CELLS 1 6\n5 0 1 2 3 0\nCELL_TYPES 1\n7\n", "cells of VTK's type 7");
  check_is_refused("a.vtk", vtk + "CELLS 1 5\n4 0 1 2 9\nCELL_TYPES 1\n10\n", "");
  check_is_refused("a.vtk", vtk, "");
  check_is_refused("a.vtu", "", "neither the first line of a .vtk file nor a tag <VTKFile");
}

TEST_CASE("a mesh of tetrahedra with a mistake is refused with the numbers of its elements and nodes") {
  auto cells = in_cube;
  cells.push_back(in_cube[1]);
  check_is_refused("a.msh", msh_22(as_tetrahedra(cells)), "are one tetrahedron, which must be listed once");
  cells.back() = {1, 2, 3, 6}; // below the face 1 2 3 from the same side
  check_is_refused("a.msh", msh_22(as_tetrahedra(cells)), "which lie on the same side of it and overlap");
  const std::string two = std::string(cube_nodes) + "9 5 0 0\n10 6 0 0\n11 5 1 0\n12 5 0 1\n";
  cells.back() = {9, 10, 11, 12};
  check_is_refused("a.msh", msh_22(as_tetrahedra(cells), two, 12), "falls into 2 pieces");
  cells.back() = {9, 10, 11, 12}; // its node 9 in the middle of the cube's edge from 2 to 3
  check_is_refused(
      "a.msh",
      msh_22(as_tetrahedra(cells), std::string(cube_nodes) + "9 1 0.5 0\n10 2 0 0\n11 2 1 0\n12 2 0 1\n", 12),
      "");
  const std::string hanging = std::string(cube_nodes) + "9 1 0.5 0\n10 2 0.5 0\n";
  cells.back() = {9, 10, 3, 7};
  check_is_refused("a.msh", msh_22(as_tetrahedra(cells), hanging, 10),
                   "node 9 at (1, 0.5, 0) lies on the face of nodes");
}
