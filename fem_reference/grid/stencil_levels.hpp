#pragma once

#include "fem_reference/grid/inertia.hpp"
#include "mechanics/grid/cycle.hpp"

namespace springproof::fem_reference::grid {

/// The tangent of a body and an approximate inverse of it: a multigrid cycle. Coarse matrices are Galerkin's,
/// made cell by cell, which is exact because the grids are nested. If the tangent is not symmetric, they are
/// made from its symmetric part.
class StencilLevels {
 public:
  StencilLevels(const Body& body, int n_threads, const mechanics::grid::Chebyshev& smoother);

  /// Assembles the tangent at a state and prepares the cycle.
  /// @param inertia  its matrix is added; or null
  void linearise(const double* displacement, const double* pressure, const Inertia* inertia = nullptr);

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
    const double *displacement, *pressure;
    const Inertia* inertia; ///< or null
  };
  const Body& body_;
  Space space_;
  State state_{}; ///< the cycle was prepared in it
  mechanics::grid::Cycle cycle_;
  StencilLevel* finest_ = nullptr;
};

} // namespace springproof::fem_reference::grid
