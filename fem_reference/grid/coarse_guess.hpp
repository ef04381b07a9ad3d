#pragma once

#include "fem_reference/grid/grid_equations.hpp"

#include <optional>

namespace springproof::fem_reference::grid {

/// What the body in cells twice as large, with its loads and supports, tells of a path from rest.
struct CoarseGuess {
  std::optional<mechanics::Vector> state; ///< near the equilibrium at the end; none where it was not found
  double first_load_step = 1;             ///< to try, of the path; less than 1 where the coarse body failed
};

/// The equilibrium of the body in cells twice as large, found the same way and interpolated. A body too small
/// to be worth it tells nothing.
CoarseGuess coarse_guess(const Body& body, const Supported& supported, double load_factor, int n_threads);

} // namespace springproof::fem_reference::grid
