#pragma once

#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <string>

namespace springproof::mechanics {

/// Newton's method at one load factor after the other, with the limits on all of them.
class Newton {
 public:
  /// Thrown when a limit on all load steps is reached, or should_stop() says so.
  struct Stopped {
    std::string reason;
  };

  Newton(NonlinearProblem& problem, const EquilibriumSettings& settings)
      : problem_(problem), settings_(settings) {}

  /// On success `at` is in equilibrium; otherwise it is of no use. The forcing is choice 2 of Eisenstat and
  /// Walker (1996), gamma = 0.9, alpha = 2, never tighter than what the tolerance asks for.
  /// @param fallback          for directions where the exact tangent has none
  /// @param iteration_factor  how many times the usual number of iterations it may take
  bool solve(Vector& at, double load_factor, Convexity fallback, int iteration_factor = 1);

  int iterations() const { return iterations_; }
  int convexified_steps() const { return convexified_steps_; }
  double residual() const { return residual_; }           ///< relative, the last one
  const std::string& failure() const { return failure_; } ///< why the last solve() that failed did

 private:
  NonlinearProblem& problem_;
  const EquilibriumSettings& settings_;
  int iterations_ = 0, convexified_steps_ = 0;
  double residual_ = 0;
  std::string failure_;

  void check_limits() const;
  bool take_step(Vector& at, Vector& residual, double forcing, double load_factor, Convexity fallback);
  bool is_rounding(const Vector& at, const Vector& residual, double load_factor);
  bool fail(const char* reason);
};

} // namespace springproof::mechanics
