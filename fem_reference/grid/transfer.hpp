#pragma once

#include "fem_reference/grid/field.hpp"

#include <array>

namespace springproof::fem_reference::grid {

/// Trilinear interpolation from a grid to the one it was coarsened from along some axes, and its transpose.
/// Field entries without a node are neither read nor written.
template<class Real>
void prolong(const Layout& coarse_layout, const Layout& fine_layout, const std::array<bool, 3>& axes,
             const Field<Real>& coarse, Field<Real>& fine, int n_threads);
template<class Real>
void restrict(const Layout& fine_layout, const Layout& coarse_layout, const std::array<bool, 3>& axes,
              const Field<Real>& fine, Field<Real>& coarse, int n_threads);

} // namespace springproof::fem_reference::grid
