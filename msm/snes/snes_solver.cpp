#include "msm/snes/snes_solver.hpp"

#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/interruption.hpp"
#include "msm/snes/snes.hpp"

#include <utility>

namespace springproof::msm {

using mechanics::petsc::check;
namespace petsc = mechanics::petsc;

SnesSolver::SnesSolver(Equations equations, petsc::Vector residual, petsc::Matrix tangent, double tolerance,
                       int max_iterations)
    : equations_(std::move(equations)), residual_(std::move(residual)), tangent_(std::move(tangent)) {
  MPI_Comm communicator = MPI_COMM_NULL;
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(residual_.get()), &communicator));
  const SNES snes = petsc::get<SNES>(SNESCreate, communicator);
  snes_.reset(snes);
  check(SNESSetOptionsPrefix(snes, "msm_"));
  const auto evaluate_residual = [](SNES, Vec at, Vec out, void* solver) {
    auto& self = *static_cast<SnesSolver*>(solver);
    return self.errors_.run([&] {
      mechanics::check_interruption();
      if (self.equations_.should_stop()) throw mechanics::Newton::Stopped{"it was stopped"};
      self.equations_.residual(at, out);
    });
  };
  const auto evaluate_tangent = [](SNES, Vec at, Mat matrix, Mat, void* solver) {
    auto& self = *static_cast<SnesSolver*>(solver);
    return self.errors_.run([&] { self.equations_.tangent(at, matrix); });
  };
  check(SNESSetFunction(snes, residual_.get(), evaluate_residual, this));
  check(SNESSetJacobian(snes, tangent_.get(), tangent_.get(), evaluate_tangent, this));
  check(SNESSetType(snes, SNESNEWTONLS));
  // On the residual: next to the solution the energy's change drowns in rounding, and PETSc's search with it.
  check(SNESLineSearchSetType(petsc::get<SNESLineSearch>(SNESGetLineSearch, snes), SNESLINESEARCHBT));
  check(SNESSetTolerances(snes, tolerance, 0, 0, max_iterations, PETSC_DEFAULT));
  choose_linear_solver();
  check(SNESSetFromOptions(snes));
}

void SnesSolver::choose_linear_solver() {
  const KSP linear = linear_solver();
  const PC preconditioner = petsc::get<PC>(KSPGetPC, linear);
  PetscInt n_unknowns = 0;
  check(MatGetSize(tangent_.get(), &n_unknowns, nullptr));
  if (n_unknowns <= factorised_by_snes) {
    check(KSPSetType(linear, KSPPREONLY));
    check(PCSetType(preconditioner, PCCHOLESKY));
    check(PCFactorSetMatSolverType(preconditioner,
                                   MATSOLVERMUMPS)); // PETSc's CHOLMOD ends all on indefinite ones
    return;
  }
  check(KSPSetType(linear, KSPCG));
  check(PCSetType(preconditioner, PCGAMG));
  check(KSPSetTolerances(linear, 1e-5, PETSC_DEFAULT, PETSC_DEFAULT, 500));
  check(SNESKSPSetUseEW(snes_.get(), PETSC_TRUE));
}

mechanics::NonlinearProblem::Solved SnesSolver::solve(Vec at) {
  const SNES snes = snes_.get();
  errors_.call([&] { return SNESSolve(snes, nullptr, at); });
  petsc::check_memory_of(linear_solver());
  last_linear_iterations_ = petsc::get<PetscInt>(SNESGetLinearSolveIterations, snes);
  return {petsc::get<SNESConvergedReason>(SNESGetConvergedReason, snes) > 0,
          petsc::get<PetscInt>(SNESGetIterationNumber, snes),
          petsc::get<PetscReal>(SNESGetFunctionNorm, snes)};
}

void SnesSolver::set_tolerance(double tolerance) {
  PetscReal relative = 0, step = 0;
  PetscInt max_iterations = 0, max_evaluations = 0;
  check(SNESGetTolerances(snes_.get(), nullptr, &relative, &step, &max_iterations, &max_evaluations));
  check(SNESSetTolerances(snes_.get(), tolerance, relative, step, max_iterations, max_evaluations));
}

bool SnesSolver::solve_tangent(Vec right, Vec solution, double tolerance, int max_iterations) {
  const KSP linear = linear_solver();
  PetscReal usual = 0, absolute = 0, divergence = 0;
  PetscInt usual_iterations = 0;
  check(KSPGetTolerances(linear, &usual, &absolute, &divergence, &usual_iterations));
  const auto has_forcing = petsc::get<PetscBool>(SNESKSPGetUseEW, snes_.get());
  check(SNESKSPSetUseEW(snes_.get(), PETSC_FALSE)); // it would take the last iteration's tolerance
  check(KSPSetTolerances(linear, tolerance, absolute, divergence, max_iterations));
  check(KSPSetOperators(linear, tangent_.get(), tangent_.get()));
  check(KSPSolve(linear, right, solution));
  check(KSPSetTolerances(linear, usual, absolute, divergence, usual_iterations));
  check(SNESKSPSetUseEW(snes_.get(), has_forcing));
  petsc::check_memory_of(linear);
  last_linear_iterations_ = petsc::get<PetscInt>(KSPGetIterationNumber, linear);
  return petsc::get<KSPConvergedReason>(KSPGetConvergedReason, linear) > 0;
}

KSP SnesSolver::linear_solver() const {
  return petsc::get<KSP>(SNESGetKSP, snes_.get());
}

bool SnesSolver::is_direct() const {
  const PC preconditioner = petsc::get<PC>(KSPGetPC, linear_solver());
  PetscBool is_direct = PETSC_FALSE;
  check(PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCCHOLESKY, &is_direct));
  return is_direct == PETSC_TRUE;
}

long SnesSolver::n_negative_pivots() const {
  const Mat factor = petsc::get<Mat>(PCFactorGetMatrix, petsc::get<PC>(KSPGetPC, linear_solver()));
  return petsc::get<PetscInt>(MatMumpsGetInfog, factor, 12);
}

} // namespace springproof::msm
