#pragma once

#include "cases/case/enumeration.hpp"

namespace springproof::cases {

/// What became of a body under its load.
SPRINGPROOF_ENUMERATION(Outcome,
                        unknown,              ///< the solver gave up, or stability was not looked at
                        stable_equilibrium,   ///< full load carried, tangent positive definite
                        unstable_equilibrium, ///< in balance, but some small motion lowers the energy
                        limit_point,          ///< the path from rest ends below the full load
                        mechanism,            ///< some motion meets no stiffness at rest
                        refused               ///< the input makes no model
)

} // namespace springproof::cases
