#pragma once

#include "cases/scene/scene.hpp"
#include "msm/design/design.hpp"

namespace springproof::compare {

/// Whether the springs of a scene are designed for its mesh as a whole: those of isotropic materials on
/// tetrahedra, and the hybrid and the designs that begin with it on hexahedra that are no grid.
bool is_designed_by_shape(const cases::Scene& scene);

/// The designs of such a scene: hybrid's, matched's and midline's stiffnesses by fit_by_shape(), on
/// tetrahedra also the springs that were published for them. Warnings tell how far the springs are from the
/// material.
/// @throws InputError when the design or a material has no meaning on tetrahedra
msm::DesignResult design_by_shape(const cases::Scene& scene);

} // namespace springproof::compare
