#pragma once

#include "cases/case/solution.hpp"

#include <functional>
#include <string>
#include <vector>

namespace springproof::compare {

/// Adds to a solution of a given number of iterations how far it is from an equilibrium, and says so in its
/// message.
/// @param equilibrium  finds the displacement of that, mm   @throws cases::SolveError
/// @param of           whose it is, to follow "the equilibrium of "
void add_distance(cases::Solution& solution, const std::string& of,
                  const std::function<std::vector<Eigen::Vector3d>()>& equilibrium);

} // namespace springproof::compare
