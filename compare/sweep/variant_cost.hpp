#pragma once

#include "compare/sweep/sweep.hpp"

namespace springproof::compare {

/// Of each of the sweep's variants, in the order of its plan: what timing it takes, in the unit of
/// estimated_cost().
std::vector<double> estimated_costs(const Sweep& sweep);

} // namespace springproof::compare
