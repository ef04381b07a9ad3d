#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::cases {

/// The faces of the body's surface that a tool may touch: those of its region, or all. Planes of symmetry are
/// no part of the surface.
/// @param scene  also a refined one
/// @throws InputError, at the region, if it has none
std::vector<FaceNodes> touched_faces(const Scene& scene, const Tool& tool);

} // namespace springproof::cases
