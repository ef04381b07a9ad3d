#pragma once

#include "mechanics/grid/transfer.hpp"
#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Trilinear interpolation between a body and the coarsened one, and its transpose. Between parts, or a part
/// and the whole of the coarser body on every rank, all functions are collective; fields have their owners'
/// values on ghosts.
template<class Real>
class Transfer {
 public:
  Transfer(const Body& fine, const Body& coarse, int n_threads);

  /// fine = interpolation of coarse; 0 on constrained entries.
  void prolong(const Field<Real>& coarse, Field<Real>& fine) const;
  /// coarse = transpose of prolong times fine.
  void restrict(const Field<Real>& fine, Field<Real>& coarse) const;
  /// coarse = fine where a coarse node lies on a fine one that moves, the mean of the moving nodes around it
  /// elsewhere, and extrapolated where the coarse cells reach beyond the body.
  void sample(const Field<Real>& fine, Field<Real>& coarse) const;

 private:
  const Body& fine_;
  const Body& coarse_;
  const Body& coarse_here_; ///< coarse_, or its part around a fine part
  int n_threads_;
  std::array<int, 3> factor_, shift_; ///< as in Interpolation
  mechanics::grid::Interpolation<Real> interpolation_;
  std::vector<char> has_cell_; ///< one per node of the fine body; empty: all have

  bool gathers() const { return &coarse_ != &coarse_here_; }
  template<class Make>
  void make_coarse(Field<Real>& coarse, const Make& make) const;
  void sample_here(const Field<Real>& fine, Field<Real>& coarse) const;
};

} // namespace springproof::msm::grid
