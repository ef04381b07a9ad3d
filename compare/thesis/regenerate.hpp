#pragma once

#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/results.hpp"

#include <functional>
#include <string>
#include <vector>

namespace springproof::compare {

/// Solves what the tables need, each solve once, and computes every number of ThesisResults.
/// @param tables    numbers; empty: all of them, and the comparison of designs and the advice, which look at
///                  every table
/// @param progress  told the number of solves done and in all
/// @throws InputError for an unknown table
ThesisResults regenerate(const std::vector<std::string>& tables, const SolveOptions& options,
                         const std::function<void(int done, int all)>& progress);

} // namespace springproof::compare
