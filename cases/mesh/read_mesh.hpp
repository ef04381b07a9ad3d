#pragma once

#include "cases/case/body.hpp"
#include "cases/mesh/mesh.hpp"

namespace springproof::cases {

/// Name of a group where groups of several dimensions have the same name: "skin (surface)".
std::string name_in_dimension(const std::string& name, int dimension);

/// Reads a mesh of hexahedra or of tetrahedra, linear or of a higher order, whose corners are taken alone: a
/// gmsh mesh (.msh, formats 2 and 4), a VTK file (.vtu, .vtk), or what gmsh makes of a .geo. Physical
/// groups of every dimension become the mesh's groups, under their names, or their numbers where they have
/// none; a VTK file has whole numbers of its cells as groups. Groups with the same name are one if the
/// one of the highest dimension, below 3, has all their nodes; else a group of nodes gets its
/// name_in_dimension(), and one of cells is in group_of_cell alone. Nodes that no cell has are left out;
/// equal cuboids along the axes become a grid (find_grid). Tetrahedra that are all inside out are turned.
/// @param remarks  receives what was left out or changed, and where groups come from
/// @throws InputError, at the place of `file` in the case file, if it cannot be read or is of another format;
/// if it has cells of no shape that a mesh can have, or of several; if check_mesh() refuses it; if a group
/// has an element that is not part of a cell
Mesh read_mesh(const MeshFile& mesh, std::vector<std::string>* remarks = nullptr);

struct MeshFileContent;
struct MeshWithRemarks {
  Mesh mesh;
  std::vector<std::string> remarks;
};

/// The mesh of what a file holds, with its groups, but not yet in mm.
/// @throws std::runtime_error with the reasons of read_mesh()
MeshWithRemarks mesh_of(MeshFileContent content);

/// A mesh for mesh_from(), but for its grid.
std::string bytes_of_mesh(const Mesh& mesh);

/// The mesh in bytes that anybody may have made, with its grid if it is one (find_grid).
/// @throws std::runtime_error if they hold no mesh: no cells, a node that does not exist, a position that is
/// not finite
Mesh mesh_from(const std::string& bytes);

/// A face of a cell.
struct CellFace {
  FaceNodes vertices; ///< ascending
  std::size_t cell;
  FaceNodes around; ///< the same vertices, seen from outside of the cell anticlockwise
};

/// The faces of every cell, so that those of the same vertices follow each other, the lowest cell first.
std::vector<CellFace> faces_of_cells(const Mesh& mesh);

/// Numbers of a mesh's nodes and cells in the file that it was made from, for messages.
struct MeshNumbers {
  std::vector<std::size_t> of_nodes, of_cells;
};

/// Checks that a mesh is sound, whatever it was made from; a grid of cells is so by construction. The models
/// would take a mistake for a crack, or for more material than there is.
/// @param faces  faces_of_cells() of the mesh
/// @throws std::runtime_error with the first of these, by the file's numbers: cells that are inverted or
/// degenerate, listed twice, on one side of the face between them, or three at a face; pieces that share no
/// node; nodes at the surface that lie on a cell (to 1 % of the shortest edge there) of which they are no
/// vertices: in the place of one, on a face (hanging), or inside
void check_mesh(const Mesh& mesh, const std::vector<CellFace>& faces, const MeshNumbers& numbers);

} // namespace springproof::cases
