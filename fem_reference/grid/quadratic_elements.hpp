#pragma once

#include "fem_reference/grid/body.hpp"

namespace springproof::fem_reference::grid {

/// Triquadratic elements (pointwise pressure) on the nodes of a body whose cells are the eighths of theirs.
/// Their tangent is applied from the moduli at the 27 Gauss points; the body's trilinear tangent in the same
/// state, which is spectrally equivalent to it (Orszag 1980), preconditions it.
class QuadraticElements {
 public:
  /// @param nodes  the body of eighths; every size, and the first plane of every rank, must be even
  /// @param cells  the elements; a rank has those above its first plane
  QuadraticElements(const Body& nodes, Body cells, int n_threads);

  /// Adds the internal force.  @return whether the rank's own elements are valid, as in Checks
  bool add_force(const double* displacement, double* force, double* cell_volumes) const;
  void linearise(const double* displacement);
  /// product = tangent * field on all entries, with the tangent last linearised. The field's ghosts are
  /// brought up to date.
  void product(Field<double>& field, Field<double>& product) const;

  const Body& cells() const { return cells_; }

 private:
  Body cells_;
  Slab slab_;          ///< the nodes'
  Layout nodes_;       ///< all nodes that are held
  Layout above_first_; ///< without what lies below the rank's first plane
  int n_threads_;
  std::vector<float> moduli_;
  Quadratic view() const;
};

} // namespace springproof::fem_reference::grid
