#pragma once

#include "compare/sweep/analysis.hpp"

namespace springproof::compare {

/// Error against time, log-log, as NAME.svg and NAME.png for both errors and both clocks, with the Pareto
/// front, the reference's uncertainty and the floor of each spring design.
/// @return the names of the figures drawn; none without a reference
/// @throws InputError as draw()
std::vector<std::string> plot_sweep(const std::string& folder, const Sweep& sweep);

} // namespace springproof::compare
