#pragma once

#include <Eigen/Core>

/// Decompositions of small dense matrices, by Eigen. They are compiled once: every size of matrix takes the
/// compiler some five seconds wherever it is decomposed.
namespace springproof::mechanics {

/// Any dense matrix whose columns are contiguous, without a copy.
using DenseMatrix = Eigen::Ref<const Eigen::MatrixXd>;

/// Eigenvalues in ascending order and their orthonormal eigenvectors, a column each. Inside a multiple
/// eigenvalue the basis is whatever the solver returned.
struct Spectrum {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Eigenvalues of a symmetric matrix in ascending order.  @param matrix  only its lower triangle is read
Eigen::VectorXd eigenvalues(const DenseMatrix& matrix);
/// Eigenvalues and eigenvectors of a symmetric matrix.  @param matrix  only its lower triangle is read
Spectrum spectrum(const DenseMatrix& matrix);
/// The solution x of A x = b.  @param matrix  A, symmetric positive definite; only its lower triangle is read
Eigen::VectorXd solved(const DenseMatrix& matrix, const Eigen::Ref<const Eigen::VectorXd>& right_side);
/// A^-1/2 of a symmetric positive definite A.  @param matrix  only its lower triangle is read
Eigen::MatrixXd inverse_square_root(const DenseMatrix& matrix);
/// Singular values in descending order.
Eigen::VectorXd singular_values(const DenseMatrix& matrix);
/// Singular values in descending order, and all right singular vectors: one for each column of the matrix, so
/// that there are more of them than values where it has fewer rows.
Spectrum right_singular(const DenseMatrix& matrix);

} // namespace springproof::mechanics
