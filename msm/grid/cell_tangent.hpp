#pragma once

#include "msm/grid/body.hpp"

#include <Eigen/Core>

namespace springproof::msm::grid {

/// A cell's stiffness between its vertices, by pairs of components: xx, yy, zz, yz, xz, xy.
using Corners = Eigen::Matrix<float, 8, 8>;
using CellMatrix = std::array<Corners, 6>;
constexpr int n_pairs = 6;
constexpr int first_of_pair[n_pairs] = {0, 1, 2, 1, 0, 0}, second_of_pair[n_pairs] = {0, 1, 2, 2, 2, 1};

/// Stiffness of a cell's spring by the axes that it crosses: bit a, axis a.
double stiffness_across(const CellSprings& cell, int axes);

/// The clamped tangent of a body's cells one by one, for a preconditioner.
class CellTangent {
 public:
  /// @param body  must outlive it
  explicit CellTangent(const Body& body);
  /// @param displacement  mm, at the cell's vertices
  /// @return N/mm. Springs whose ends coincide, which have no direction, are left out
  CellMatrix at(const CellSprings& cell, const CellPositions& displacement) const;

 private:
  const Body& body_;
  std::array<double, 8> rest_length_; ///< mm, by the axes that a spring leads along
};

} // namespace springproof::msm::grid
