#pragma once

#include "fem_reference/grid/field.hpp"

#include <array>

namespace springproof::fem_reference::grid {

/// Trilinear interpolation from a grid to the one it was coarsened from along some axes, and its transpose.
/// Field entries without a node are neither read nor written; ghosts of both fields are brought up to date.
template<class Real>
void prolong(const Space& coarse_space, const Space& fine_space, const std::array<bool, 3>& axes,
             Field<Real>& coarse, Field<Real>& fine);
template<class Real>
void restrict(const Space& fine_space, const Space& coarse_space, const std::array<bool, 3>& axes,
              Field<Real>& fine, Field<Real>& coarse);

} // namespace springproof::fem_reference::grid
