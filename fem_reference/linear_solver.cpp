#include "fem_reference/linear_solver.hpp"

#include <utility>

namespace springproof::fem_reference {

namespace {

/// Makes MUMPS count all negative pivots: those of the root that ranks share are left out otherwise.
void count_all_pivots(Mat factor) {
  check(MatMumpsSetIcntl(factor, 13, 1)); // the root on one rank
}

int negative_pivots(Mat factor) {
  return static_cast<int>(get<PetscInt>(MatMumpsGetInfog, factor, 12)); // INFOG(12): over all ranks
}

std::optional<int> negative_pivots_of_symmetric_part(Mat tangent) {
  const Matrix owned(get<Mat>(MatTranspose, tangent, MAT_INITIAL_MATRIX));
  Mat symmetric = owned.get();
  check(MatAXPY(symmetric, 1, tangent, UNKNOWN_NONZERO_PATTERN)); // twice the symmetric part: the same signs
  check(MatSetOption(symmetric, MAT_SYMMETRIC, PETSC_TRUE));
  const Matrix factor(get<Mat>(MatGetFactor, symmetric, MATSOLVERMUMPS, MAT_FACTOR_CHOLESKY));
  count_all_pivots(factor.get());
  const auto info = get<MatFactorInfo>(MatFactorInfoInitialize);
  check(MatCholeskyFactorSymbolic(factor.get(), symmetric, nullptr, &info));
  check(MatCholeskyFactorNumeric(factor.get(), symmetric, &info));
  if (get<MatFactorError>(MatFactorGetError, factor.get()) != MAT_FACTOR_NOERROR) return std::nullopt;
  return negative_pivots(factor.get());
}

} // namespace

LinearSolver::LinearSolver(const Discretisation& d, Mat tangent, TangentSymmetry symmetry)
    : solver_(get<KSP>(KSPCreate, d.communicator)), tangent_(tangent), symmetry_(symmetry),
      n_pressures_(static_cast<int>(d.n_pressures)) {
  KSP solver = solver_.get();
  check(KSPSetOptionsPrefix(solver, "fem_"));
  check(KSPSetOperators(solver, tangent_, tangent_));
  const auto preconditioner = get<PC>(KSPGetPC, solver);
  const bool symmetric = symmetry == TangentSymmetry::symmetric;
  // An unstable state's tangent is not positive definite. The option only makes MUMPS take pivots from the
  // diagonal, which is a fifth faster, and still counts the negative ones; a factorisation gone bad would
  // show in the residual.
  const bool has_pressures = d.element.pressure == Pressure::nodes;
  if (symmetric) check(MatSetOption(tangent_, has_pressures ? MAT_SYMMETRIC : MAT_SPD, PETSC_TRUE));
  if (!has_pressures) mechanics::petsc::attach_rigid_motions(tangent, d.nodes.point);
  // an iterative solve leaves Newton a factor of 1e5 a step, hardly less than its quadratic convergence
  check(KSPSetTolerances(solver, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  if (has_pressures || d.constraints.n_unknowns <= direct_solver_limit) {
    check(KSPSetType(solver, KSPPREONLY));
    check(PCSetType(preconditioner, symmetric ? PCCHOLESKY : PCLU));
    check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
    if (has_pressures) {
      check(PCFactorSetUpMatSolverType(preconditioner));
      const Mat factor = get<Mat>(PCFactorGetMatrix, preconditioner);
      count_all_pivots(factor);
      check(MatMumpsSetIcntl(factor, 14, 100)); // percent of room for pivots that are put off
    }
  } else {
    // Pressures are condensed, so the tangent stays definite and multigrid applies to it even when nearly
    // incompressible: at a bulk modulus of 1000 shear moduli some 145 iterations a solve, with 3630 unknowns
    // as with 26,460; some 10 with a Poisson's ratio of 0.35. A block preconditioner for u-p would need
    // fewer.
    check(KSPSetType(solver, symmetric ? KSPCG : KSPGMRES));
    check(PCSetType(preconditioner, PCGAMG));
  }
  check(KSPSetFromOptions(solver));
  is_direct_ = get<PetscBool>(PetscObjectTypeCompare, reinterpret_cast<PetscObject>(solver), KSPPREONLY);
}

bool LinearSolver::solve(Vec right_hand_side, Vec solution, long tangent_number) {
  KSP solver = solver_.get();
  check(KSPSetOperators(solver, tangent_, tangent_));
  const bool is_new = std::exchange(tangent_number_, tangent_number) != tangent_number;
  if (is_direct_ && is_new) ++n_factorisations_; // PETSc factorises anew then
  check(KSPSolve(solver, right_hand_side, solution));
  mechanics::petsc::check_memory_of(solver);
  if (!is_direct_) n_iterations_ += get<PetscInt>(KSPGetIterationNumber, solver);
  return get<KSPConvergedReason>(KSPGetConvergedReason, solver) > 0;
}

std::optional<int> LinearSolver::negative_eigenvalues() const {
  const auto preconditioner = get<PC>(KSPGetPC, solver_.get());
  const auto package = get<MatSolverType>(PCFactorGetMatSolverType, preconditioner);
  if (!is_direct_ || !get<PetscBool>(PetscStrcmp, package, MATSOLVERMUMPS)) return std::nullopt;
  std::optional<int> found = symmetry_ == TangentSymmetry::unsymmetric
                                 ? negative_pivots_of_symmetric_part(tangent_)
                                 : negative_pivots(get<Mat>(PCFactorGetMatrix, preconditioner));
  if (found) *found -= n_pressures_; // an unknown count where a pressure that no motion feels is no negative pivot
  return found && *found < 0 ? std::nullopt : found;
}

} // namespace springproof::fem_reference
