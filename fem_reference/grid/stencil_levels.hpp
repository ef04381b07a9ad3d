#pragma once

#include "fem_reference/grid/inertia.hpp"
#include "mechanics/grid/cycle.hpp"

#include <functional>

namespace springproof::fem_reference::grid {

/// The tangent of a body and an approximate inverse of it: a multigrid cycle. Coarse matrices are Galerkin's,
/// made cell by cell, which is exact because the grids are nested. If the tangent is not symmetric, they are
/// made from its symmetric part.
class StencilLevels {
 public:
  StencilLevels(const Body& body, int n_threads, const mechanics::grid::Chebyshev& smoother);

  /// Assembles the tangent at a state and prepares the cycle.
  /// @param inertia  its matrix is added; or null
  void linearise(const double* displacement, const double* internal, const Inertia* inertia = nullptr);

  /// Drops what a state far off may have left.
  void forget() { cycle_.forget(); }

  /// product = tangent * field, 0 on constrained entries when they are left out. The field's ghosts are
  /// brought up to date.
  enum class Rows { free, all };
  void product(Field<double>& field, Field<double>& product, Rows rows = Rows::free) const;

  /// solution = cycle(right_side).
  void apply(const Field<double>& right_side, Field<double>& solution) {
    cycle_.apply(right_side, norm(space_, right_side), solution);
  }

  const Space& space() const { return space_; }

 private:
  class StencilLevel;
  struct State {
    const double *displacement, *internal;
    const Inertia* inertia; ///< or null
  };
  const Body& body_;
  Space space_;
  State state_{}; ///< the cycle was prepared in it
  mechanics::grid::Cycle cycle_;
  StencilLevel* finest_ = nullptr;
};

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
