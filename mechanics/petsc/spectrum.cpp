#include "mechanics/petsc/spectrum.hpp"

#include "cases/case/error.hpp"
#include "mechanics/petsc/handles.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <slepceps.h>
#include <string>

namespace springproof::mechanics::petsc {

namespace {

/// Uses the values where they are.
Matrix symmetric_matrix(Eigen::SparseMatrix<double>& values) {
  const auto size = static_cast<PetscInt>(values.rows());
  values.makeCompressed();
  // Compressed columns of a symmetric matrix are its compressed rows.
  Matrix matrix(get<Mat>(MatCreateSeqAIJWithArrays, PETSC_COMM_SELF, size, size, values.outerIndexPtr(),
                         values.innerIndexPtr(), values.valuePtr()));
  check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
  return matrix;
}

/// @param stiffness, mass  read in place; null: the eigenpairs of the stiffness alone
Spectrum lowest_pairs(Eigen::SparseMatrix<double>& stiffness, Eigen::SparseMatrix<double>* mass,
                      int n_pairs) {
  // The shift is far enough below zero that the shifted matrix is safely definite, near enough that low modes
  // stay dominant.
  const double shift = -1e-4 * stiffness.diagonal().mean() / (mass ? mass->diagonal().mean() : 1);
  const auto size = static_cast<PetscInt>(stiffness.rows());
  const Matrix matrix = symmetric_matrix(stiffness), weights = mass ? symmetric_matrix(*mass) : Matrix();
  const Owned<EPS, EPSDestroy> owned(get<EPS>(EPSCreate, PETSC_COMM_SELF));
  EPS solver = owned.get();
  check(EPSSetOperators(solver, matrix.get(), weights.get()));
  check(EPSSetProblemType(solver, mass ? EPS_GHEP : EPS_HEP));
  check(EPSSetDimensions(solver, n_pairs, std::min<PetscInt>(size, 3 * n_pairs + 20), PETSC_DEFAULT));
  check(EPSSetTarget(solver, shift));
  check(EPSSetWhichEigenpairs(solver, EPS_TARGET_MAGNITUDE));
  check(EPSSetTolerances(solver, 1e-12, 1000));
  const auto transformation = get<ST>(EPSGetST, solver);
  check(STSetType(transformation, STSINVERT));
  const auto linear = get<KSP>(STGetKSP, transformation);
  check(KSPSetType(linear, KSPPREONLY));
  const auto factorisation = get<PC>(KSPGetPC, linear);
  check(PCSetType(factorisation, PCCHOLESKY));
  check(PCFactorSetMatSolverType(factorisation, MATSOLVERMUMPS));
  check(EPSSolve(solver));
  const auto n_found = get<PetscInt>(EPSGetConverged, solver);
  if (n_found < n_pairs)
    throw cases::SolveError("eigenproblem: only " + std::to_string(n_found) + " of " +
                            std::to_string(n_pairs) + " eigenpairs converged");
  Spectrum found{Eigen::VectorXd(n_found), Eigen::MatrixXd(size, n_found)};
  for (PetscInt i = 0; i < n_found; ++i) {
    const Vector column(
        get<Vec>(VecCreateSeqWithArray, PETSC_COMM_SELF, 1, size, found.vectors.col(i).data()));
    check(EPSGetEigenpair(solver, i, &found.values(i), nullptr, column.get(), nullptr));
  }
  std::vector<int> order(n_found);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return found.values(a) < found.values(b); });
  order.resize(n_pairs);
  return {found.values(order), found.vectors(Eigen::all, order)};
}

} // namespace

Spectrum lowest_spectrum(Eigen::SparseMatrix<double> matrix, int n_pairs) {
  return lowest_pairs(matrix, nullptr, n_pairs);
}

Spectrum lowest_vibrations(Eigen::SparseMatrix<double> stiffness, Eigen::SparseMatrix<double> mass,
                           int n_pairs) {
  return lowest_pairs(stiffness, &mass, n_pairs);
}

} // namespace springproof::mechanics::petsc
