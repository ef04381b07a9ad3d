#pragma once

#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Trilinear interpolation between a body and the coarsened one, and its transpose.
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
  bool is_coarsened_[3]; ///< along x, y, z
  int n_threads_;
};

} // namespace springproof::msm::grid
