#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/spring_body.hpp"

namespace springproof::msm {

/// Stress, strain, energy and reactions of a body of springs in equilibrium under the scene's loads times a
/// factor, whichever solver has found it; where ranks share the solution, each rank's share. Collective.
///  - A cell has its part of the springs that it shares; see mechanics/field_sums.hpp for the stress. In a
///    lattice that is deformed affinely every cell has the stress of the infinite lattice, at the boundary
///    too; but where springs have at the boundary what they have inside (Boundary::whole), a cell there has
///    more of them than one inside, and a stress of its own.
///  - A network's springs belong to no cell: reactions, the whole energy and the cells' strain, without
///  stress
///    and energy of cells.
/// @param solution  its displacement is read
cases::Fields fields(const cases::Scene& scene, const SpringBody& springs, const cases::Solution& solution,
                     double load_factor = 1);

} // namespace springproof::msm
