#pragma once

#include "cases/case/body.hpp"
#include "cases/mesh/mesh.hpp"

namespace springproof::cases {

/// The body of a closed surface, filled with tetrahedra by gmsh or with the cubes of a voxel body.
/// @param remarks  receives the volumes of body and surface and the largest distance between the two; what
/// was left out of the file
/// @throws InputError, at the surface's place in the case file, if it cannot be read, is open, has edges of
/// more than two triangles or crosses itself; if the cells would be too many; if the body falls into pieces
Mesh fill_surface(const FilledSurface& body, std::vector<std::string>& remarks);

/// About how many tetrahedra or cubes that makes.
double count_cells(const FilledSurface& body);

} // namespace springproof::cases
