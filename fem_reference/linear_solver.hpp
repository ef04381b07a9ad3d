#pragma once

#include "fem_reference/discretisation.hpp"

#include <optional>

namespace fem_reference {

/// Most unknowns that MUMPS factorises by default; above it an iterative method runs. A cube of 10x10x10
/// cells has 3630 and of 20x20x20 26,460; fill grows with the power 4/3 and time with the square.
constexpr long direct_solver_limit = 60000;

/// Newton's linear systems. PETSc's options database overrides every choice under the prefix "fem_".
class LinearSolver {
 public:
  LinearSolver(const Discretisation& discretisation, TangentSymmetry symmetry);

  struct Outcome {
    bool solved;
    int iterations; ///< of the Krylov method; 0 for a direct solve
  };
  /// Solves with the discretisation's tangent as it is now.
  Outcome solve(Vec right_hand_side, Vec solution);

  /// Negative pivots of the last factorisation, when it was symmetric and direct.
  std::optional<int> negative_pivots() const;

 private:
  Solver solver_;
  Mat tangent_;
};

} // namespace fem_reference
