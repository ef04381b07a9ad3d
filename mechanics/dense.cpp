#include "mechanics/dense.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

namespace springproof::mechanics {

using Solver = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>;

Eigen::VectorXd eigenvalues(const DenseMatrix& matrix) {
  return Solver(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

Spectrum spectrum(const DenseMatrix& matrix) {
  const Solver solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd solved(const DenseMatrix& matrix, const Eigen::Ref<const Eigen::VectorXd>& right_side) {
  return matrix.ldlt().solve(right_side);
}

Eigen::MatrixXd inverse_square_root(const DenseMatrix& matrix) {
  return Solver(matrix).operatorInverseSqrt();
}

Eigen::VectorXd singular_values(const DenseMatrix& matrix) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
}

Spectrum right_singular(const DenseMatrix& matrix) {
  const Eigen::JacobiSVD<Eigen::MatrixXd> parts(matrix, Eigen::ComputeThinU | Eigen::ComputeFullV);
  return {parts.singularValues(), parts.matrixV()};
}

} // namespace springproof::mechanics
