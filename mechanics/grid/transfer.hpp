#pragma once

#include "mechanics/grid/field.hpp"

#include <array>
#include <optional>

namespace springproof::mechanics::grid {

/// How many cells along each axis a coarser one has: 2 along those whose spacing is (almost) the smallest, so
/// that cells tend to cubes, 1 along the others; nothing where no axis has more than two cells.
std::optional<std::array<int, 3>> coarsening_factor(const std::array<int, 3>& cells,
                                                    const Eigen::Vector3d& spacing);

/// Trilinear interpolation between a grid and a coarser one, or the parts of them that are here, and its
/// transpose. Entries without a node are neither read nor written.
template<class Real>
class Interpolation {
 public:
  /// @param factor  cells along each axis of a coarser one
  /// @param shift   node i of the coarse grid lies on node factor * i + shift of the fine one; not above 0,
  ///                along x not below -1
  Interpolation(const Layout& fine, const Layout& coarse, const std::array<int, 3>& factor,
                const std::array<int, 3>& shift, int n_threads);

  /// fine = interpolation of coarse
  void prolong(const Field<Real>& coarse, Field<Real>& fine) const;
  /// coarse = transpose of prolong times fine, in the coarse planes from begin to end - 1.
  void restrict(const Field<Real>& fine, Field<Real>& coarse, int begin, int end) const;

 private:
  Layout fine_, coarse_;
  std::array<int, 3> factor_, shift_;
  int n_threads_;
  mutable Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic> rows_; ///< room: a row for every plane

  template<class Stencil, class AlongX>
  void transfer(const Layout& from, const Field<Real>& source, const Layout& to, Field<Real>& result,
                int begin, int end, const Stencil& stencil, const AlongX& along_x) const;
};

} // namespace springproof::mechanics::grid
