#pragma once

#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// Whether the cells of a mesh are equal cuboids along the axes, however they are numbered and turned; if so,
/// mesh.grid is set, and the cells are put in the order and orientation that Grid asks for. Nodes keep their
/// numbers and positions. Positions may be off by 1e-8 of the spacing, which is what mesh generators leave.
/// @return whether a grid was found
bool find_grid(HexMesh& mesh);

} // namespace springproof::cases
