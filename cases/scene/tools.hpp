#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::cases {

/// Reads the surfaces of files that tools are.
/// @param remarks  what was left out of the files, or turned
/// @throws InputError, at the file's name, if it cannot be read or is no rigid_surface()
void read_surfaces(std::vector<Tool>& tools, std::vector<std::string>& remarks);

/// The faces of the body's surface that a tool may touch: those of its region, or all. Planes of symmetry are
/// no part of the surface.
/// @param scene  also a refined one
/// @throws InputError, at the region, if it has none
std::vector<FaceNodes> touched_faces(const Scene& scene, const Tool& tool);

/// The shortest side of these faces, mm.
double shortest_side(const Scene& scene, const Tool& tool);

} // namespace springproof::cases
