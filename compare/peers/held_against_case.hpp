#pragma once

#include "cases/scene/scene.hpp"

namespace springproof::compare {

/// What a case says to displacements that another program gives as an answer to it.
struct HeldAgainstCase {
  std::string message; ///< how far they are from an equilibrium of the case's springs; empty: there are none
  std::vector<std::string> warnings; ///< what no answer to the case does
};

/// Looks whether supports hold and moved regions are where the case moves them, to 1 % of the largest
/// displacement, and what the case's springs and loads say: |g - F| / |F| on free degrees of freedom, g the
/// gradient of the springs' energy, and |(g - F) . u|, over the larger one of |F . u| and the springs' whole
/// g . u. Finite elements of the same body leave most of the first, and of the second what their stiffness
/// differs by; half of it is left by displacements in other axes, in metres, or under another load.
/// @param displacement  mm, one per node
HeldAgainstCase hold_against_case(const cases::Scene& scene,
                                  const std::vector<Eigen::Vector3d>& displacement);

} // namespace springproof::compare
