#include "msm/design/linear_method.hpp"

#include "msm/design/bounded_least_squares.hpp"
#include "msm/tangent.hpp"

namespace springproof::msm {

CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms) {
  const Lattice lattice = cell_lattice(terms, vertices);
  CellMatrix matrix = CellMatrix::Zero();
  visit_tangent_blocks(lattice, lattice.rest, TransverseTerm::exact,
                       [&](int row, int column, const Eigen::Matrix3d& block) {
                         matrix.block<3, 3>(3 * row, 3 * column) += block;
                         if (row != column) matrix.block<3, 3>(3 * column, 3 * row) += block.transpose();
                       });
  return matrix;
}

LinearFit linear_method(const CellMatrix& reference, const CellVertices& vertices) {
  Eigen::MatrixXd unit(576, 3);
  const std::array<CellStiffness, 3> units = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  for (int c = 0; c < 3; ++c)
    unit.col(c) = cell_stiffness_matrix(vertices, units[static_cast<std::size_t>(c)]).reshaped();
  const double size = reference.diagonal().mean(); // of a spring's stiffness, roughly
  const Eigen::Vector3d k = bounded_least_squares(unit, reference.reshaped(), size);
  return {{k(0), k(1), k(2), 0}, (reference.reshaped() - unit * k).norm()};
}

CellStiffness pseudo_stiffness(const CellStiffness& stiffness, double youngs_modulus, double edge) {
  const double unit = youngs_modulus * edge / 2;
  return {stiffness.edge / unit, stiffness.face_diagonal / unit, stiffness.internal_diagonal / unit,
          stiffness.volume / youngs_modulus};
}

} // namespace springproof::msm
