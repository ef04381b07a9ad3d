#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "msm/cell_terms.hpp"

/// Stress, strain, energy and reactions of a body of springs in equilibrium under the scene's loads times a
/// factor, whichever solver has found it; where ranks share the solution, each rank's share. Collective.
/// @param solution  its displacement is read
namespace springproof::msm {

/// A cell has the springs and the volume term of its own stiffness, so that a spring between cells is shared
/// as its stiffness is; see mechanics/field_sums.hpp for the stress. In a lattice that is deformed affinely
/// every cell has the stress of the infinite lattice, at the boundary too.
/// @param stiffness  one for every cell of the scene's mesh, or a single one for all
cases::Fields fields(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                     const cases::Solution& solution, double load_factor = 1);

/// The same of cells of terms. Where springs have at the boundary what they have inside (Boundary::whole), a
/// cell there has more of them than one inside, and a stress of its own.
cases::Fields fields(const cases::Scene& scene, const BodyTerms& terms, const cases::Solution& solution,
                     double load_factor = 1);

/// Of a network, whose springs belong to no cell: reactions, the whole energy, and the cells' strain;
/// without stress and energy of cells.
/// @param network  all of it on every rank
cases::Fields network_fields(const cases::Scene& scene, const Lattice& network,
                             const cases::Solution& solution, double load_factor = 1);

} // namespace springproof::msm
