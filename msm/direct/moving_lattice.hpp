#pragma once

#include "msm/moving_springs.hpp"

#include <memory>

namespace springproof::msm {

/// The motion of any lattice: the tangent of a step assembled and factorised by CHOLMOD.
/// @param problem  of make_moving_problem(), with its lattice; must outlive what is returned, as must springs
/// @param springs  make_direct_system(problem)
std::unique_ptr<MovingSprings> make_moving_lattice(const Problem& problem, SpringSystem& springs,
                                                   const Inertia& inertia);

} // namespace springproof::msm
