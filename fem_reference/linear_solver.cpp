#include "fem_reference/linear_solver.hpp"

#include <cstring>

namespace fem_reference {

namespace {

/// Rigid motions as near-kernel of the tangent: what algebraic multigrid must represent on its coarse levels.
void attach_rigid_motions(const Discretisation& d) {
  Vec points = nullptr;
  check(MatCreateVecs(d.tangent, &points, nullptr));
  const Vector owned(points);
  check(VecSetBlockSize(points, 3));
  PetscScalar* values = nullptr;
  check(VecGetArray(points, &values));
  for (int node = 0; node < d.n_owned_nodes; ++node)
    for (int c = 0; c < 3; ++c) values[3 * node + c] = d.node_point[static_cast<std::size_t>(node)][c];
  check(VecRestoreArray(points, &values));
  MatNullSpace rigid = nullptr;
  check(MatNullSpaceCreateRigidBody(points, &rigid));
  const NullSpace owned_space(rigid);
  check(MatSetNearNullSpace(d.tangent, rigid));
}

} // namespace

LinearSolver::LinearSolver(const Discretisation& d, TangentSymmetry symmetry) : tangent_(d.tangent) {
  KSP solver = nullptr;
  PC preconditioner = nullptr;
  check(KSPCreate(d.communicator, &solver));
  solver_.reset(solver);
  check(KSPSetOptionsPrefix(solver, "fem_"));
  check(KSPSetOperators(solver, tangent_, tangent_));
  check(KSPGetPC(solver, &preconditioner));
  const bool symmetric = symmetry == TangentSymmetry::symmetric;
  if (symmetric) check(MatSetOption(tangent_, MAT_SYMMETRIC, PETSC_TRUE));
  if (d.n_unknowns <= direct_solver_limit) {
    check(KSPSetType(solver, KSPPREONLY));
    check(PCSetType(preconditioner, symmetric ? PCCHOLESKY : PCLU));
    check(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS));
  } else {
    attach_rigid_motions(d);
    check(KSPSetType(solver, symmetric ? KSPCG : KSPGMRES));
    check(PCSetType(preconditioner, PCGAMG));
    check(KSPSetTolerances(solver, 1e-8, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  }
  check(KSPSetFromOptions(solver));
}

LinearSolver::Outcome LinearSolver::solve(Vec right_hand_side, Vec solution) {
  check(KSPSetOperators(solver_.get(), tangent_, tangent_));
  check(KSPSolve(solver_.get(), right_hand_side, solution));
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  PetscInt iterations = 0;
  PetscBool direct = PETSC_FALSE;
  check(KSPGetConvergedReason(solver_.get(), &reason));
  check(KSPGetIterationNumber(solver_.get(), &iterations));
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(solver_.get()), KSPPREONLY, &direct));
  return {reason > 0, direct ? 0 : static_cast<int>(iterations)};
}

std::optional<int> LinearSolver::negative_pivots() const {
  PC preconditioner = nullptr;
  PCType type = nullptr;
  check(KSPGetPC(solver_.get(), &preconditioner));
  check(PCGetType(preconditioner, &type));
  if (type == nullptr || std::strcmp(type, PCCHOLESKY) != 0) return std::nullopt;
  Mat factor = nullptr;
  MatSolverType package = nullptr;
  PetscInt negative = 0;
  check(PCFactorGetMatSolverType(preconditioner, &package));
  if (package == nullptr || std::strcmp(package, MATSOLVERMUMPS) != 0) return std::nullopt;
  check(PCFactorGetMatrix(preconditioner, &factor));
  check(MatMumpsGetInfog(factor, 12, &negative)); // INFOG(12): negative pivots of all ranks
  return static_cast<int>(negative);
}

} // namespace fem_reference
