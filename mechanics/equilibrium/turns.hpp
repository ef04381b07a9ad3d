#pragma once

#include "mechanics/equilibrium/find_equilibrium.hpp"

namespace springproof::mechanics {

/// Settings with load steps in which no support turns by more than cases::largest_turn_of_step.
/// @param degrees   that a support turns by at load factor 1
/// @param settings  with the load factors from and to
/// @param at_least  load steps from load factor 0 to 1
EquilibriumSettings in_small_turns(double degrees, int at_least, EquilibriumSettings settings);

} // namespace springproof::mechanics
