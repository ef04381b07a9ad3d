#pragma once

#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <optional>
#include <string>

namespace springproof::mechanics {

/// Room for line searches: a state, and the residual there.
struct Trial {
  Vector at, residual;
  std::optional<double> energy{}; ///< where the last search has ended; none: not known
};

/// Moves `at` along a step as far as the problem's merit allows, shortening the step. Next to the solution an
/// energy's change drowns in rounding: there a falling residual decides.
/// @param residual  the residual at `at`; on success that at its new value
/// @param expect    what will be asked after the full step
/// @param trial     work space, kept between searches if nothing else moves `at`
/// @return whether a fraction of the step would do; otherwise `at` and `residual` are as they were
bool line_search(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Trial& trial, Expect expect = Expect::residual);

/// Newton's method at one load factor after the other, with the limits on all of them.
class Newton {
 public:
  /// Thrown when a limit on all load steps is reached, or should_stop() says so.
  struct Stopped {
    std::string reason;
  };

  /// @param result  counts the iterations and convexified steps; its residual is the last one
  Newton(NonlinearProblem& problem, const EquilibriumSettings& settings, Equilibrium& result)
      : problem_(problem), settings_(settings), result_(result) {}

  /// Moves `at` to an equilibrium; on failure `at` is meaningless. The forcing is choice 2 of Eisenstat and
  /// Walker (1996), gamma = 0.9, alpha = 2, never tighter than what the tolerance asks for.
  /// @param fallback          convexity to use where the exact tangent gives no direction
  /// @param iteration_factor  how many times the usual number of iterations it may take
  bool solve(Vector& at, double load_factor, Convexity fallback, int iteration_factor = 1);

  const std::string& failure() const { return failure_; } ///< reason of the last failed solve()

 private:
  NonlinearProblem& problem_;
  const EquilibriumSettings& settings_;
  Equilibrium& result_;
  std::string failure_;
  Vector residual_, step_; ///< kept, as the trial, from one solve() to the next
  Trial trial_;

  void check_limits() const;
  bool take_step(Vector& at, double forcing, double load_factor, Convexity fallback);
  bool take_full_step(Vector& at, double load_factor, Expect expect);
  bool may_be_rounding(double relative_residual) const;
  bool is_rounding(const Vector& at, double load_factor);
  bool fail(const char* reason);
};

} // namespace springproof::mechanics
