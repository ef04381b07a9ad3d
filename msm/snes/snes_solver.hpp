#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"
#include "mechanics/petsc/handles.hpp"

#include <functional>

namespace springproof::msm {

/// Unknowns up to which a tangent is factorised; there both ways take about as long.
constexpr PetscInt factorised_up_to = 30000;

/// PETSc's Newton method with a line search on the residual, for equations with a symmetric tangent: MUMPS up
/// to factorised_up_to unknowns, conjugate gradients with algebraic multigrid (GAMG) beyond. Its options have
/// the prefix msm_.
class SnesSolver {
 public:
  /// What PETSc calls, on all ranks in the same order; all may throw.
  struct Equations {
    std::function<void(Vec at, Vec residual)> residual;
    std::function<void(Vec at, Mat tangent)> tangent;
    std::function<bool()> should_stop; ///< asked before every residual; of all ranks
  };
  /// @param residual, tangent  room for them, which gives the solver its layout
  /// @param tolerance          on the norm of the residual, N
  SnesSolver(Equations equations, mechanics::petsc::Vector residual, mechanics::petsc::Matrix tangent,
             double tolerance, int max_iterations);
  SnesSolver(const SnesSolver&) = delete; // PETSc has its address
  SnesSolver& operator=(const SnesSolver&) = delete;

  /// From where `at` is.
  /// @return the residual is absolute, N
  /// @throws mechanics::Newton::Stopped if should_stop() says so; what an equation has thrown; std::bad_alloc
  /// for want of memory
  mechanics::NonlinearProblem::Solved solve(Vec at);

  Mat tangent() const { return tangent_.get(); }
  KSP linear_solver() const;
  bool is_direct() const;              ///< whether the tangent is factorised
  long last_linear_iterations() const; ///< of the last solve()

 private:
  Equations equations_;
  mechanics::petsc::Vector residual_;
  mechanics::petsc::Matrix tangent_;
  mechanics::petsc::NonlinearSolver snes_;
  mechanics::petsc::CallbackErrors errors_;

  void choose_linear_solver();
};

} // namespace springproof::msm
