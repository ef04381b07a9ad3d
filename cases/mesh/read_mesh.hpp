#pragma once

#include "cases/case/body.hpp"
#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// Name of a group where groups of several dimensions have the same name: "skin (surface)".
std::string name_in_dimension(const std::string& name, int dimension);

/// Reads a gmsh mesh (.msh, format 4) of eight-node hexahedra, or has gmsh mesh a .geo. Physical groups of
/// every dimension become the mesh's groups, under their names, or their numbers where they have none. Groups
/// with the same name are one if the group of the highest dimension, below 3, has all their nodes; else a
/// group of nodes gets its name_in_dimension(), and one of cells is in group_of_cell alone. Nodes that no
/// hexahedron has are left out; equal cuboids along the axes become a grid (find_grid).
/// @throws InputError, at the place of `file` in the case file, if it cannot be read or is of another format;
/// if it has no hexahedra or other three-dimensional cells; if check_mesh() refuses it; if an element of a
/// group is not part of a hexahedron
HexMesh read_mesh(const MeshFile& mesh);

} // namespace springproof::cases
