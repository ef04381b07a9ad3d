#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::cases {

/// Reads the surface that a scene's case names, if it names one.
/// @throws InputError, at the place in the case file, if it is none or has more than five million triangles
void read_surface_of(Scene& scene);

} // namespace springproof::cases
