#pragma once

#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// A mesh for mesh_from(), but for its grid.
std::string bytes_of_mesh(const HexMesh& mesh);

/// The mesh in bytes that anybody may have made, with its grid if it is one (find_grid).
/// @throws std::runtime_error if they hold no mesh: no cells, a node that does not exist, a position that is
/// not finite
HexMesh mesh_from(const std::string& bytes);

} // namespace springproof::cases
