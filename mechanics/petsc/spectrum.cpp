#include "mechanics/petsc/spectrum.hpp"

#include "cases/case/error.hpp"
#include "mechanics/petsc/handles.hpp"

#include <algorithm>
#include <numeric>
#include <slepceps.h>
#include <string>

namespace springproof::mechanics::petsc {

namespace {

using OwnedSolver = Owned<EPS, EPSDestroy>;

/// For the eigenpairs of a symmetric matrix.
OwnedSolver solver_for(Mat matrix) {
  OwnedSolver solver(get<EPS>(EPSCreate, PETSC_COMM_SELF));
  check(EPSSetOperators(solver.get(), matrix, nullptr));
  check(EPSSetProblemType(solver.get(), EPS_HEP));
  return solver;
}

Spectrum solve(EPS solver, PetscInt size, PetscInt n_wanted) {
  check(EPSSolve(solver));
  const auto n_found = get<PetscInt>(EPSGetConverged, solver);
  if (n_found < n_wanted)
    throw cases::SolveError("eigenproblem: only " + std::to_string(n_found) + " of " +
                            std::to_string(n_wanted) + " eigenpairs converged");
  Spectrum found{Eigen::VectorXd(n_found), Eigen::MatrixXd(size, n_found)};
  for (PetscInt i = 0; i < n_found; ++i) {
    const Vector column(
        get<Vec>(VecCreateSeqWithArray, PETSC_COMM_SELF, 1, size, found.vectors.col(i).data()));
    check(EPSGetEigenpair(solver, i, &found.values(i), nullptr, column.get(), nullptr));
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
  const Matrix matrix(get<Mat>(MatCreateSeqDense, PETSC_COMM_SELF, n, n, symmetric.data()));
  const OwnedSolver solver = solver_for(matrix.get());
  check(EPSSetType(solver.get(), EPSLAPACK));
  check(EPSSetDimensions(solver.get(), n, PETSC_DEFAULT, PETSC_DEFAULT));
  return solve(solver.get(), n, n);
}

Spectrum lowest_spectrum(Eigen::SparseMatrix<double> values, int n_pairs) {
  const auto size = static_cast<PetscInt>(values.rows());
  values.makeCompressed();
  // Compressed columns of a symmetric matrix are its compressed rows.
  const Matrix matrix(get<Mat>(MatCreateSeqAIJWithArrays, PETSC_COMM_SELF, size, size, values.outerIndexPtr(),
                               values.innerIndexPtr(), values.valuePtr()));
  check(MatSetOption(matrix.get(), MAT_SYMMETRIC, PETSC_TRUE));
  const OwnedSolver solver = solver_for(matrix.get());
  // Far enough below zero that the shifted matrix is safely definite, near enough that low modes stay
  // dominant.
  const double shift = -1e-4 * values.diagonal().mean();
  check(EPSSetDimensions(solver.get(), n_pairs, std::min<PetscInt>(size, 3 * n_pairs + 20), PETSC_DEFAULT));
  check(EPSSetTarget(solver.get(), shift));
  check(EPSSetWhichEigenpairs(solver.get(), EPS_TARGET_MAGNITUDE));
  check(EPSSetTolerances(solver.get(), 1e-12, 1000));
  const auto transformation = get<ST>(EPSGetST, solver.get());
  check(STSetType(transformation, STSINVERT));
  const auto linear = get<KSP>(STGetKSP, transformation);
  check(KSPSetType(linear, KSPPREONLY));
  const auto factorisation = get<PC>(KSPGetPC, linear);
  check(PCSetType(factorisation, PCCHOLESKY));
  check(PCFactorSetMatSolverType(factorisation, MATSOLVERMUMPS));
  return solve(solver.get(), size, n_pairs);
}

} // namespace springproof::mechanics::petsc
