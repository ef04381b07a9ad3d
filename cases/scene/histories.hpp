#pragma once

#include "cases/scene/scene.hpp"

/// How the factors of a scene's loads and moved regions follow time.
namespace springproof::cases {

/// Whether the factor of a load follows time.
bool has_load_histories(const Scene& scene);

/// Whether the factor of a load or a moved region jumps after time 0 and before the motion's end.
/// @param scene  of a dynamic case
bool jumps_on_the_way(const Scene& scene);

} // namespace springproof::cases
