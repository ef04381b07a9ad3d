#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// Reads a gmsh mesh (.msh, format 4) of eight-node hexahedra, or has gmsh mesh a .geo. Physical groups of
/// every dimension become the mesh's groups, under their names, or their numbers where they have none; groups
/// of the same name are one. Nodes that no hexahedron has are left out; equal cuboids along the axes become a
/// grid (find_grid).
/// @throws InputError, at the place of `file` in the case file, if it cannot be read or is of another format;
/// if it has no hexahedra, inverted ones or other three-dimensional cells; if it is not connected; if an
/// element of a group is not part of a hexahedron
HexMesh read_mesh(const MeshFile& file);

} // namespace springproof::cases
