#pragma once

#include "msm/grid/body.hpp"
#include "msm/moving_springs.hpp"

namespace springproof::msm::grid {

/// An inertia's masses of cells, t, and these times mass_damping, t/s, as a body's kernels read them.
struct CellMasses {
  std::vector<double> mass, damping; ///< by Layout::cell(), and 16 entries more
  /// @param inertia  with consistent masses    @param body  whole
  CellMasses(const cases::Grid& grid, const Body& body, const Inertia& inertia);
};

/// What consistent masses have beyond lumped ones: an operator on fields that moves no rigid body.
template<class Real>
class ConsistentMasses {
 public:
  /// @param body, cells  must outlive this
  ConsistentMasses(const Body& body, const CellMasses& cells, int n_threads);

  /// product += (mass M + damping C) direction; stays 0 on constrained entries.
  void add_product(double mass, double damping, const Field<Real>& direction, Field<Real>& product);

 private:
  const Body& body_;
  const CellMasses& cells_;
  int n_threads_;
  std::vector<std::ptrdiff_t> held_;     ///< constrained entries that have a cell
  double mass_factor_ = 0, damping_ = 0; ///< factors of the last product,
  std::vector<Real> factored_;           ///< and the cells' masses with them
};

} // namespace springproof::msm::grid
