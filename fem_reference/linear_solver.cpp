#include "fem_reference/linear_solver.hpp"

#include "mechanics/petsc/rigid_motions.hpp"

#include <cstring>

namespace springproof::fem_reference {

namespace {

int negative_pivots(Mat factor) {
  PetscInt negative = 0;
  check(MatMumpsGetInfog(factor, 12, &negative)); // INFOG(12): over all ranks
  return static_cast<int>(negative);
}

std::optional<int> negative_pivots_of_symmetric_part(Mat tangent) {
  Mat symmetric = nullptr, factor = nullptr;
  check(MatTranspose(tangent, MAT_INITIAL_MATRIX, &symmetric));
  const Matrix owned_symmetric(symmetric);
  check(MatAXPY(symmetric, 1, tangent, UNKNOWN_NONZERO_PATTERN)); // twice the symmetric part: the same signs
  check(MatSetOption(symmetric, MAT_SYMMETRIC, PETSC_TRUE));
  check(MatGetFactor(symmetric, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY, &factor));
  const Matrix owned_factor(factor);
  MatFactorInfo info;
  MatFactorError error = MAT_FACTOR_NOERROR;
  check(MatFactorInfoInitialize(&info));
  check(MatCholeskyFactorSymbolic(factor, symmetric, nullptr, &info));
  check(MatCholeskyFactorNumeric(factor, symmetric, &info));
  check(MatFactorGetError(factor, &error));
  if (error != MAT_FACTOR_NOERROR) return std::nullopt;
  return negative_pivots(factor);
}

} // namespace

LinearSolver::LinearSolver(const Discretisation& d, Mat tangent, TangentSymmetry symmetry)
    : tangent_(tangent), symmetry_(symmetry) {
  KSP solver = nullptr;
  PC preconditioner = nullptr;
  check(KSPCreate(d.communicator, &solver));
  solver_.reset(solver);
  check(KSPSetOptionsPrefix(solver, "fem_"));
  check(KSPSetOperators(solver, tangent_, tangent_));
  check(KSPGetPC(solver, &preconditioner));
  const bool symmetric = symmetry == TangentSymmetry::symmetric;
  // An unstable state's tangent is not positive definite. The option only makes MUMPS take pivots from the
  // diagonal, which is a fifth faster, and still counts the negative ones; a factorisation gone bad would
  // show in the residual.
  if (symmetric) check(MatSetOption(tangent_, MAT_SPD, PETSC_TRUE));
  mechanics::petsc::attach_rigid_motions(tangent, d.nodes.point);
  // an iterative solve leaves Newton a factor of 1e5 a step, hardly less than its quadratic convergence
  check(KSPSetTolerances(solver, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  if (d.constraints.n_unknowns <= direct_solver_limit) {
    check(KSPSetType(solver, KSPPREONLY));
    check(PCSetType(preconditioner, symmetric ? PCCHOLESKY : PCLU));
    check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  } else {
    // Pressures are condensed, so the tangent stays definite and multigrid applies to it even when nearly
    // incompressible: at a bulk modulus of 1000 shear moduli some 145 iterations a solve, with 3630 unknowns
    // as with 26,460; some 10 with a Poisson's ratio of 0.35. A block preconditioner for u-p would need
    // fewer.
    check(KSPSetType(solver, symmetric ? KSPCG : KSPGMRES));
    check(PCSetType(preconditioner, PCGAMG));
  }
  check(KSPSetFromOptions(solver));
}

LinearSolver::Outcome LinearSolver::solve(Vec right_hand_side, Vec solution, long tangent_number) {
  check(KSPSetOperators(solver_.get(), tangent_, tangent_));
  if (is_direct() && tangent_number != factorised_number_) ++n_factorisations_; // PETSc factorises anew then
  factorised_number_ = tangent_number;
  check(KSPSolve(solver_.get(), right_hand_side, solution));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  check(KSPGetConvergedReason(solver_.get(), &reason));
  check(KSPGetIterationNumber(solver_.get(), &iterations));
  return {reason > 0, is_direct() ? 0 : static_cast<int>(iterations)};
}

bool LinearSolver::is_direct() const {
  PetscBool direct = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(solver_.get()), KSPPREONLY, &direct));
  return direct == PETSC_TRUE;
}

std::optional<int> LinearSolver::negative_eigenvalues() const {
  PC preconditioner = nullptr;
  Mat factor = nullptr;
  MatSolverType package = nullptr;
  check(KSPGetPC(solver_.get(), &preconditioner));
  if (!is_direct()) return std::nullopt;
  check(PCFactorGetMatSolverType(preconditioner, &package));
  if (package == nullptr || std::strcmp(package, MATSOLVERMUMPS) != 0) return std::nullopt;
  if (symmetry_ == TangentSymmetry::unsymmetric) return negative_pivots_of_symmetric_part(tangent_);
  check(PCFactorGetMatrix(preconditioner, &factor));
  return negative_pivots(factor);
}

} // namespace springproof::fem_reference
