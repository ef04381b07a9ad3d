#include "compare/modes/spectrum.hpp"

#include "cases/case/error.hpp"
#include "mechanics/petsc/handles.hpp"

#include <algorithm>
#include <numeric>
#include <slepceps.h>
#include <string>
#include <vector>

namespace springproof::compare {

namespace {

namespace petsc = mechanics::petsc;
using petsc::check;
using OwnedSolver = petsc::Owned<EPS, EPSDestroy>;

/// For the eigenpairs of a symmetric matrix.
OwnedSolver solver_for(Mat matrix) {
  EPS solver = nullptr;
  check(EPSCreate(PETSC_COMM_SELF, &solver));
  OwnedSolver owned(solver);
  check(EPSSetOperators(solver, matrix, nullptr));
  check(EPSSetProblemType(solver, EPS_HEP));
  return owned;
}

Spectrum solve(EPS solver, PetscInt size, PetscInt n_wanted) {
  check(EPSSolve(solver));
  PetscInt n_found = 0;
  check(EPSGetConverged(solver, &n_found));
  if (n_found < n_wanted)
    throw cases::SolveError("eigenproblem: only " + std::to_string(n_found) + " of " +
                                std::to_string(n_wanted) + " eigenpairs converged",
                            0, 0);
  Spectrum found{Eigen::VectorXd(n_found), Eigen::MatrixXd(size, n_found)};
  for (PetscInt i = 0; i < n_found; ++i) {
    Vec column = nullptr;
    check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, size, found.vectors.col(i).data(), &column));
    const petsc::Vector owned(column);
    check(EPSGetEigenpair(solver, i, &found.values(i), nullptr, column, nullptr));
  }
  std::vector<int> order(n_found);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return found.values(a) < found.values(b); });
  order.resize(n_wanted);
  return {found.values(order), found.vectors(Eigen::all, order)};
}

} // namespace

Spectrum full_spectrum(const Eigen::MatrixXd& values) {
  Eigen::MatrixXd symmetric = (values + values.transpose()) / 2; // read in place by PETSc
  const auto n = static_cast<PetscInt>(values.rows());
  Mat matrix = nullptr;
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, symmetric.data(), &matrix));
  const petsc::Matrix owned(matrix);
  const OwnedSolver solver = solver_for(matrix);
  check(EPSSetType(solver.get(), EPSLAPACK));
  check(EPSSetDimensions(solver.get(), n, PETSC_DEFAULT, PETSC_DEFAULT));
  return solve(solver.get(), n, n);
}

Spectrum lowest_spectrum(Eigen::SparseMatrix<double> values, int n_pairs) {
  const auto size = static_cast<PetscInt>(values.rows());
  values.makeCompressed();
  Mat matrix = nullptr; // compressed columns of a symmetric matrix are its compressed rows
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, size, size, values.outerIndexPtr(), values.innerIndexPtr(),
                                  values.valuePtr(), &matrix));
  const petsc::Matrix owned(matrix);
  check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  const OwnedSolver solver = solver_for(matrix);
  // Far enough below zero that the shifted matrix is safely definite, near enough that low modes stay
  // dominant.
  const double shift = -1e-4 * values.diagonal().mean();
  ST transformation = nullptr;
  KSP linear = nullptr;
  PC factorisation = nullptr;
  check(EPSSetDimensions(solver.get(), n_pairs, std::min<PetscInt>(size, 3 * n_pairs + 20), PETSC_DEFAULT));
  check(EPSSetTarget(solver.get(), shift));
  check(EPSSetWhichEigenpairs(solver.get(), EPS_TARGET_MAGNITUDE));
  check(EPSSetTolerances(solver.get(), 1e-12, 1000));
  check(EPSGetST(solver.get(), &transformation));
  check(STSetType(transformation, STSINVERT));
  check(STGetKSP(transformation, &linear));
  check(KSPSetType(linear, KSPPREONLY));
  check(KSPGetPC(linear, &factorisation));
  check(PCSetType(factorisation, PCCHOLESKY));
  check(PCFactorSetMatSolverType(factorisation, MATSOLVERMUMPS));
  return solve(solver.get(), size, n_pairs);
}

} // namespace springproof::compare
