#pragma once

#include "cases/case/body.hpp"
#include "cases/mesh/mesh.hpp"

#include <optional>

namespace springproof::cases {

/// The body of a closed surface, filled with tetrahedra by gmsh or with the cubes of a voxel body.
/// @param remarks  receives the volumes of body and surface and the largest distance between the two; what
/// was left out of the file
/// @throws InputError, at the surface's place in the case file, if it cannot be read, is open, has edges of
/// more than two triangles or crosses itself; if the cells would be too many; if the body falls into pieces
Mesh fill_surface(const FilledSurface& body, std::vector<std::string>& remarks);

/// The same body of cubes, or nothing where tetrahedra fill it.
std::optional<Voxels> as_voxels(const FilledSurface& body);

/// About how many tetrahedra fill a body.
/// @throws InputError if its surface cannot be read
double count_tetrahedra(const FilledSurface& body);

} // namespace springproof::cases
