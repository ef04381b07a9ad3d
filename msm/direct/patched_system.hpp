#pragma once

#include "msm/problem.hpp"

#include <memory>

namespace springproof::msm {

/// Nodes from which a lattice with volume terms at its nodes is solved by conjugate gradients. Below, its
/// whole tangent is factorised.
constexpr std::size_t patches_iterated_from = 1500;

/// Whether make_patched_system() takes a lattice: it has volume terms at nodes, and no stiffness is negative.
bool takes_patched_system(const Lattice& lattice);

/// The equations of a lattice with volume terms at its nodes. The term of a node couples all its neighbours,
/// so the factor of the whole tangent is several times that of the springs. Conjugate gradients, with the
/// factorised springs as preconditioner, need the springs' factor alone. The condition number is at most one
/// plus what volume terms store in a motion over what springs store in it: it grows as K / mu.
/// @param problem  must outlive the system
std::unique_ptr<SpringSystem> make_patched_system(const Problem& problem);

} // namespace springproof::msm
