#pragma once

#include "fem_reference/grid/grid_equations.hpp"
#include "mechanics/grid/coarse_guess.hpp"

namespace springproof::fem_reference::grid {

using mechanics::grid::CoarseGuess;

/// The equilibrium of the body in cells twice as large, found the same way and interpolated. A body too small
/// to be worth it tells nothing.
CoarseGuess coarse_guess(const Body& body, const Supported& supported, double load_factor, int n_threads);

} // namespace springproof::fem_reference::grid
