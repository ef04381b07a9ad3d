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

/// Returns a solver for the eigenpairs of a symmetric matrix, or of one and a mass matrix.
OwnedSolver solver_for(Mat matrix, Mat mass = nullptr) {
  OwnedSolver solver(get<EPS>(EPSCreate, PETSC_COMM_SELF));
  check(EPSSetOperators(solver.get(), matrix, mass));
  check(EPSSetProblemType(solver.get(), mass ? EPS_GHEP : EPS_HEP));
  return solver;
}

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

/// @param shift  below zero
Spectrum solve_by_shift(EPS solver, PetscInt size, int n_pairs, double shift) {
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
  return solve(solver, size, n_pairs);
}

// Shifts are far enough below zero that the shifted matrix is safely definite, near enough that low modes
// stay dominant.
constexpr double shift_of_diagonal = -1e-4;

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
  const Matrix matrix = symmetric_matrix(values);
  const OwnedSolver solver = solver_for(matrix.get());
  return solve_by_shift(solver.get(), static_cast<PetscInt>(values.rows()), n_pairs,
                        shift_of_diagonal * values.diagonal().mean());
}

Spectrum lowest_vibrations(Eigen::SparseMatrix<double> stiffness, Eigen::SparseMatrix<double> mass,
                           int n_pairs) {
  const Matrix matrix = symmetric_matrix(stiffness), mass_matrix = symmetric_matrix(mass);
  const OwnedSolver solver = solver_for(matrix.get(), mass_matrix.get());
  return solve_by_shift(solver.get(), static_cast<PetscInt>(stiffness.rows()), n_pairs,
                        shift_of_diagonal * stiffness.diagonal().mean() / mass.diagonal().mean());
}

} // namespace springproof::mechanics::petsc
