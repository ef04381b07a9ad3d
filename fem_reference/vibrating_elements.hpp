#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/vibrating_body.hpp"

namespace springproof::fem_reference {

/// The vibrations of a scene's finite elements about rest, assembled in this process alone.
/// @throws InputError as Model
mechanics::VibratingBody vibrating_body(const cases::Scene& scene);

} // namespace springproof::fem_reference
