#pragma once

#include "mechanics/dynamics/dynamic_problem.hpp"

namespace springproof::fem_reference {

/// The equations of finite elements by either backend, in equilibrium and in motion.
class ElementEquations : public mechanics::DynamicProblem {
 public:
  virtual mechanics::Vector rest() const = 0;
  /// Negative eigenvalues that is_stable() counted.
  virtual std::optional<int> negative_eigenvalues() const = 0;
  /// Whether the last direction was not found.
  virtual bool linear_solver_failed() const { return false; }
};

} // namespace springproof::fem_reference
