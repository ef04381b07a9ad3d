#pragma once

#include "compare/solve/estimate.hpp"
#include "compare/sweep/sweep.hpp"

#include <ostream>

/// What a sweep takes, before it is begun.
namespace springproof::compare {

/// Of one variant; seconds with all its rounds.
Estimate estimate_of(const Sweep& sweep, const Variant& variant);
/// Of each variant, in the order of the plan.
std::vector<double> estimated_seconds(const Sweep& sweep);

/// Leaves out the variants of the longest estimated times until the others fit into the budget, each with the
/// reason. The reference's meshes stay, whatever they take.
void cut_to_budget(Sweep& sweep, double budget_seconds);

/// @throws InputError if a variant needs more memory than there is
void check_memory(const Sweep& sweep);

/// A line per method: variants, the largest one's unknowns and memory, seconds of all; then what is left out.
void write_plan(std::ostream& out, const Sweep& sweep);

} // namespace springproof::compare
