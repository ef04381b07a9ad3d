#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/vibrating_body.hpp"
#include "msm/lattice.hpp"

namespace springproof::msm {

/// The vibrations of a scene's springs about rest: the lattice's tangent there, point masses.
mechanics::VibratingBody vibrating_body(const cases::Scene& scene, const Lattice& lattice);

} // namespace springproof::msm
