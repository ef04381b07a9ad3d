#pragma once

#include "msm/lattice.hpp"

#include <Eigen/SparseCore>

namespace springproof::msm {

/// Second derivative of energy() as 3x3 blocks: calls sink(row point, column point, block in N/mm) for every
/// contribution with row point >= column point (the matrix is symmetric). Clamped, no spring has a negative
/// transverse term, no edge of a tetrahedron a negative geometric one, and no cell the second derivative of
/// its volume under pressure, so that the sum is positive semidefinite.
template<class Sink>
void visit_tangent_blocks(const Lattice& lattice, const Points& positions, TransverseTerm term,
                          const Sink& sink) {
  for (const Link& link : lattice.links) {
    const Eigen::Matrix3d block = spring_stiffness(
        positions[cases::index(link.j)] - positions[cases::index(link.i)], link.spring, term);
    sink(link.i, link.i, block);
    sink(link.j, link.j, block);
    sink(link.j, link.i, -block);
  }
  for (const VolumeCell& cell : lattice.volume_cells) {
    const CellPositions x = cell_positions(cell, positions);
    const auto gradient = trilinear_volume_gradient(x);
    const auto second = trilinear_volume_second_derivative(x);
    const VolumeLaw law = cell.law(x);
    const double pressure = cell.stiffness * law.pressure,
                 slope = cell.stiffness / cell.rest_volume * law.slope;
    for (std::size_t a = 0; a < 8; ++a)
      for (std::size_t b = 0; b < 8; ++b) {
        if (cell.nodes[a] < cell.nodes[b]) continue;
        Eigen::Matrix3d block = slope * gradient[a] * gradient[b].transpose();
        if (term == TransverseTerm::exact) block += pressure * second[a][b];
        sink(cell.nodes[a], cell.nodes[b], block);
      }
  }
  for (const Tetrahedron& t : lattice.tetrahedra) {
    const TetrahedronMatrix tangent =
        biquadratic_tangent(tetrahedron_positions(t, positions), t.rest_lengths, t.stiffness, term);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const int row = t.nodes[cases::index(a)], column = t.nodes[cases::index(b)];
        if (row >= column) sink(row, column, Eigen::Matrix3d(tangent.block<3, 3>(3 * a, 3 * b)));
      }
  }
}

/// The sparse tangent stiffness of a lattice on its free degrees of freedom. The pattern, and every
/// contribution's place in it, are found once.
class Tangent {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  /// @param lattice   must outlive the tangent
  /// @param is_constrained  degree of freedom 3*point + component, three entries per point
  Tangent(const Lattice& lattice, const std::vector<bool>& is_constrained);

  /// Lower triangle, N/mm, at these positions (mm).
  const Matrix& assemble(const Points& positions, TransverseTerm term);

  int n_free() const { return n_free_; }
  /// Number among the free ones of degree of freedom 3*point + component, or -1.
  const std::vector<int>& free_number() const { return free_number_; }

 private:
  const Lattice& lattice_;
  std::vector<int> free_number_;
  int n_free_ = 0;
  Matrix matrix_;
  std::vector<int> slots_; ///< places among the matrix's values, 9 per block as visited; -1: none
};

} // namespace springproof::msm
