#pragma once

#include "mechanics/dense.hpp"

#include <Eigen/SparseCore>

/// Eigenpairs of sparse symmetric matrices, for callers that include none of SLEPc's headers.
namespace springproof::mechanics::petsc {

/// The lowest eigenpairs of a sparse positive semidefinite matrix, by Krylov-Schur on the inverse shifted
/// just below zero (MUMPS), so that rigid modes do no harm. As mechanics::spectrum() otherwise.
/// @param matrix    symmetric, both triangles    @param n_pairs  at most the matrix's size
/// @throws SolveError if fewer pairs converge to 1e-10 relative
Spectrum lowest_spectrum(Eigen::SparseMatrix<double> matrix, int n_pairs);

/// The lowest eigenpairs of K x = lambda M x, scaled to x^T M x = 1. As lowest_spectrum() otherwise;
/// the eigenvalue of a free body's rigid modes is 0.
/// @param stiffness  positive semidefinite, but where the mass has no rows    @param mass  positive
/// semidefinite; both symmetric, both triangles
Spectrum lowest_vibrations(Eigen::SparseMatrix<double> stiffness, Eigen::SparseMatrix<double> mass,
                           int n_pairs);

} // namespace springproof::mechanics::petsc
