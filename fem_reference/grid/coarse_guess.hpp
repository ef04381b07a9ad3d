#pragma once

#include "fem_reference/grid/grid_equations.hpp"

#include <optional>

namespace springproof::fem_reference::grid {

/// A state near the equilibrium of a body at a load factor: the interpolated one of the body in cells twice
/// as large, found the same way. Nothing when that body is too small to be worth it, or its load is not
/// carried.
std::optional<mechanics::Vector> coarse_guess(const Body& body, const Supported& supported,
                                              double load_factor, int n_threads);

} // namespace springproof::fem_reference::grid
