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

petsc::Matrix dense_matrix(const Eigen::MatrixXd& values) {
  const auto n = static_cast<PetscInt>(values.rows());
  Mat matrix = nullptr;
  check(MatCreateSeqDense(PETSC_COMM_SELF, n, n, nullptr, &matrix));
  petsc::Matrix owned(matrix);
  PetscScalar* entries = nullptr;
  check(MatDenseGetArrayWrite(matrix, &entries));
  Eigen::Map<Eigen::MatrixXd>(entries, n, n) = (values + values.transpose()) / 2;
  check(MatDenseRestoreArrayWrite(matrix, &entries));
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  return owned;
}

// Compressed columns of a symmetric matrix are its compressed rows.
petsc::Matrix sparse_matrix(const Eigen::SparseMatrix<double>& values) {
  const auto n = static_cast<PetscInt>(values.rows());
  std::vector<PetscInt> n_row(static_cast<std::size_t>(n));
  for (PetscInt i = 0; i < n; ++i)
    n_row[static_cast<std::size_t>(i)] = static_cast<PetscInt>(values.col(i).nonZeros());
  Mat matrix = nullptr;
  check(MatCreateSeqAIJ(PETSC_COMM_SELF, n, n, 0, n_row.data(), &matrix));
  petsc::Matrix owned(matrix);
  std::vector<PetscInt> columns;
  std::vector<PetscScalar> entries;
  for (PetscInt i = 0; i < n; ++i) {
    columns.clear();
    entries.clear();
    for (Eigen::SparseMatrix<double>::InnerIterator entry(values, i); entry; ++entry) {
      columns.push_back(static_cast<PetscInt>(entry.row()));
      entries.push_back(entry.value());
    }
    check(MatSetValues(matrix, 1, &i, static_cast<PetscInt>(columns.size()), columns.data(), entries.data(),
                       INSERT_VALUES));
  }
  check(MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY));
  check(MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY));
  check(MatSetOption(matrix, MAT_SYMMETRIC, PETSC_TRUE));
  return owned;
}

OwnedSolver solver_for(Mat matrix) {
  EPS solver = nullptr;
  check(EPSCreate(PETSC_COMM_SELF, &solver));
  OwnedSolver owned(solver);
  check(EPSSetOperators(solver, matrix, nullptr));
  check(EPSSetProblemType(solver, EPS_HEP));
  return owned;
}

Spectrum solve(EPS solver, Mat matrix, PetscInt n_wanted) {
  check(EPSSolve(solver));
  PetscInt n_found = 0, size = 0;
  check(EPSGetConverged(solver, &n_found));
  if (n_found < n_wanted)
    throw cases::SolveError("eigenproblem: only " + std::to_string(n_found) + " of " +
                                std::to_string(n_wanted) + " eigenpairs converged",
                            0, 0);
  check(MatGetSize(matrix, &size, nullptr));
  Spectrum found{Eigen::VectorXd(n_found), Eigen::MatrixXd(size, n_found)};
  Vec vector = nullptr;
  check(MatCreateVecs(matrix, &vector, nullptr));
  for (PetscInt i = 0; i < n_found; ++i) {
    check(EPSGetEigenpair(solver, i, &found.values(i), nullptr, vector, nullptr));
    const PetscScalar* entries = nullptr;
    check(VecGetArrayRead(vector, &entries));
    found.vectors.col(i) = Eigen::Map<const Eigen::VectorXd>(entries, size);
    check(VecRestoreArrayRead(vector, &entries));
  }
  check(VecDestroy(&vector));
  std::vector<int> order(static_cast<std::size_t>(n_found));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return found.values(a) < found.values(b); });
  order.resize(static_cast<std::size_t>(n_wanted));
  return {found.values(order), found.vectors(Eigen::all, order)};
}

} // namespace

Spectrum full_spectrum(const Eigen::MatrixXd& values) {
  const petsc::Matrix matrix = dense_matrix(values);
  const OwnedSolver solver = solver_for(matrix.get());
  const auto n = static_cast<PetscInt>(values.rows());
  check(EPSSetType(solver.get(), EPSLAPACK));
  check(EPSSetDimensions(solver.get(), n, PETSC_DEFAULT, PETSC_DEFAULT));
  return solve(solver.get(), matrix.get(), n);
}

Spectrum lowest_spectrum(const Eigen::SparseMatrix<double>& values, int n_pairs) {
  const petsc::Matrix matrix = sparse_matrix(values);
  const OwnedSolver solver = solver_for(matrix.get());
  // Far enough below zero that the shifted matrix is safely definite, near enough that low modes stay
  // dominant.
  const double shift = -1e-4 * values.diagonal().mean();
  ST transformation = nullptr;
  KSP linear = nullptr;
  PC factorisation = nullptr;
  check(EPSSetDimensions(solver.get(), n_pairs,
                         std::min<PetscInt>(static_cast<PetscInt>(values.rows()), 3 * n_pairs + 20),
                         PETSC_DEFAULT));
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
  return solve(solver.get(), matrix.get(), n_pairs);
}

} // namespace springproof::compare
