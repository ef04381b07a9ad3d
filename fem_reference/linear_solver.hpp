#pragma once

#include "fem_reference/backend.hpp"
#include "fem_reference/discretisation.hpp"

#include <optional>

namespace springproof::fem_reference {

/// Newton's linear systems. PETSc's options database overrides every choice under the prefix "fem_".
class LinearSolver {
 public:
  LinearSolver(const Discretisation& discretisation, Mat tangent, TangentSymmetry symmetry);

  /// Solves with the tangent as it is now; one that has not changed stays factorised.
  /// @param tangent_number  from 1, another one whenever the tangent has been assembled: for the count of
  /// factorisations
  /// @return whether the solver converged
  bool solve(Vec right_hand_side, Vec solution, long tangent_number);

  /// Iterations of a Krylov method so far by solve(), and factorisations; 0 with the other kind of solver.
  long n_iterations() const { return n_iterations_; }
  long n_factorisations() const { return n_factorisations_; }

  /// Negative eigenvalues of the symmetric part of the tangent last solved with, its pressures eliminated,
  /// counted by MUMPS as negative pivots; nothing when that solve was iterative. An unsymmetric tangent is
  /// factorised once more for it. Zero: the equilibrium is stable.
  std::optional<int> negative_eigenvalues() const;

 private:
  mechanics::petsc::LinearSolver solver_;
  Mat tangent_;
  TangentSymmetry symmetry_;
  int n_pressures_; ///< unknowns of the tangent's negative definite block -C
  bool is_direct_;
  long n_iterations_ = 0, n_factorisations_ = 0;
  long tangent_number_ = 0; ///< number of the tangent last solved with
};

} // namespace springproof::fem_reference
