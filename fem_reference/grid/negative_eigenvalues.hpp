#pragma once

#include "fem_reference/grid/stencil_levels.hpp"

namespace springproof::fem_reference::grid {

/// Counts the negative eigenvalues of the last linearised tangent's symmetric part, on free degrees of
/// freedom. Lanczos' method runs on the preconditioned tangent: its spectrum is a cluster about 1 and
/// whatever the cycle cannot invert, so that few steps find a negative end of it. By Sylvester's law of
/// inertia it has as many negative eigenvalues as the tangent. Runs are repeated, deflated by what was found,
/// until one finds none: a multiple eigenvalue shows once in each.
/// @param linear_iterations  added to: products with the tangent
/// @param product  multiplies by the tangent on the free degrees of freedom
int count_negative_eigenvalues(const Body& body,
                               const std::function<void(Field<double>&, Field<double>&)>& product,
                               StencilLevels& multigrid, long& linear_iterations);

} // namespace springproof::fem_reference::grid
