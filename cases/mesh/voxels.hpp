#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// The grid of cubes of a voxel body: a cube belongs to it when its centre is inside the surface (winding
/// number other than 0, by a ray along z through the centre). All cubes hang together by faces.
/// @throws InputError, at the place of the surface in the case file, if the surface is no STL or not closed,
/// if no centre is inside, if the cubes fall into pieces, or if the grid would have more than 50 million of
/// them
HexMesh make_voxel_mesh(const Voxels& voxels);

} // namespace springproof::cases
