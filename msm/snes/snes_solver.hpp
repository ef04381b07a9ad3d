#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"
#include "mechanics/petsc/handles.hpp"

#include <functional>

namespace springproof::msm {

/// PETSc's Newton method with a line search on the residual, for equations with a symmetric tangent: MUMPS up
/// to factorised_by_snes unknowns, conjugate gradients with algebraic multigrid (GAMG) beyond. Its options
/// have the prefix msm_.
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

  void set_tolerance(double tolerance); ///< on the norm of the residual, N

  Mat tangent() const { return tangent_.get(); }
  /// Solves tangent * solution = right side with the tangent as it is: exactly where it is factorised.
  /// @param tolerance  on |residual| / |right side|
  /// @return whether the solver has converged
  bool solve_tangent(Vec right, Vec solution, double tolerance, int max_iterations);
  bool is_direct() const; ///< whether the tangent is factorised
  long last_linear_iterations() const {
    return last_linear_iterations_;
  }                               ///< of the last solve() or solve_tangent()
  long n_negative_pivots() const; ///< of the last factorisation

 private:
  Equations equations_;
  mechanics::petsc::Vector residual_;
  mechanics::petsc::Matrix tangent_;
  mechanics::petsc::NonlinearSolver snes_;
  mechanics::petsc::CallbackErrors errors_;
  long last_linear_iterations_ = 0;

  KSP linear_solver() const;
  void choose_linear_solver();
};

} // namespace springproof::msm
