#include "msm/design/linear_method.hpp"

#include "msm/design/bounded_least_squares.hpp"
#include "msm/tangent.hpp"

namespace springproof::msm {

namespace {

void add_volume_term(CellMatrix& matrix, const CellVertices& vertices, double stiffness) {
  const auto by_vertex = trilinear_volume_gradient(vertices);
  Eigen::Matrix<double, 24, 1> gradient;
  for (int v = 0; v < 8; ++v) gradient.segment<3>(3 * v) = by_vertex[static_cast<std::size_t>(v)];
  matrix += stiffness / trilinear_volume(vertices) * gradient * gradient.transpose();
}

} // namespace

CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellStiffness& stiffness) {
  CellMatrix matrix = CellMatrix::Zero();
  for_each_spring(stiffness, [&](int i, int j, double of_spring, const SpringLaw&) {
    const Eigen::Vector3d d = vertices[static_cast<std::size_t>(j)] - vertices[static_cast<std::size_t>(i)];
    const Eigen::Matrix3d block = of_spring / d.squaredNorm() * d * d.transpose();
    matrix.block<3, 3>(3 * i, 3 * i) += block;
    matrix.block<3, 3>(3 * j, 3 * j) += block;
    matrix.block<3, 3>(3 * i, 3 * j) -= block;
    matrix.block<3, 3>(3 * j, 3 * i) -= block;
  });
  if (stiffness.volume != 0) add_volume_term(matrix, vertices, stiffness.volume);
  return matrix;
}

CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms) {
  cases::HexMesh cell;
  cell.nodes = std::vector<Eigen::Vector3d>(vertices.begin(), vertices.end());
  cell.cells = std::vector<std::array<int, 8>>{{0, 1, 2, 3, 4, 5, 6, 7}};
  const Lattice lattice = make_lattice(cell, BodyTerms{{terms}});
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
