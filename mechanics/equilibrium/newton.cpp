#include "mechanics/equilibrium/newton.hpp"

#include "mechanics/equilibrium/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::mechanics {

bool Newton::solve(Vector& at, double load_factor, Convexity fallback, int iteration_factor) {
  if (const auto solved = problem_.solve_at(at, load_factor)) {
    iterations_ += solved->newton_iterations;
    residual_ = solved->residual;
    check_limits();
    return solved->converged || fail("Newton's method does not converge");
  }
  // Off a saddle the way is long and winds through a narrow valley of the potential.
  const int max_iterations =
      settings_.max_newton_per_step * std::max(iteration_factor, fallback == Convexity::shifted ? 4 : 1);
  const int max_convexified = convexified_steps_ + iteration_factor * settings_.max_convexified_per_step;
  double forcing = 0.1, norm_before = 0;
  Vector residual = problem_.residual(at, load_factor, Expect::direction);
  for (int iteration = 0;; ++iteration) {
    const NonlinearProblem::Size size = problem_.size(residual, at);
    const double norm = residual_ = size.relative;
    if (!std::isfinite(norm)) return fail("cells turn inside out");
    if (norm <= settings_.tolerance && size.constraints_hold) return true;
    if (iteration == max_iterations || convexified_steps_ > max_convexified)
      return fail("Newton's method does not converge");
    const auto may_be_rounding = [&] {
      return size.constraints_hold && (problem_.moves_supports() || norm < 1e-6);
    };
    if (norm_before > 0) {
      const double ratio = norm / norm_before;
      forcing = std::min(0.1, 0.9 * ratio * ratio);
      // Close to the solution each step gains much. Where it does not, rounding may be all that is left.
      if (ratio > 0.1 && may_be_rounding() && is_rounding(at, residual, load_factor)) return true;
    }
    norm_before = norm;
    forcing = std::clamp(forcing, std::min(0.1, 0.3 * settings_.tolerance / norm), 0.1);
    check_limits();
    ++iterations_;
    if (!take_step(at, residual, forcing, load_factor, fallback))
      return (may_be_rounding() && is_rounding(at, residual, load_factor)) || fail("no step gets nearer");
  }
}

void Newton::check_limits() const {
  if (settings_.should_stop && problem_.any_rank(settings_.should_stop())) throw Stopped{"it was stopped"};
  if (iterations_ >= settings_.max_newton_iterations)
    throw Stopped{"the limit on Newton iterations was reached"};
}

bool Newton::take_step(Vector& at, Vector& residual, double forcing, double load_factor, Convexity fallback) {
  // Where convergence is quadratic the step from here is the last.
  const Expect expect = residual_ <= 1e-5 ? Expect::residual : Expect::direction;
  const auto take = [&](Convexity convexity) {
    const auto step = problem_.direction(at, residual, load_factor, forcing, convexity);
    return step && line_search(problem_, at, residual, *step, load_factor, expect);
  };
  if (take(Convexity::exact)) return true;
  if (fallback == Convexity::exact) return false;
  ++convexified_steps_;
  return take(fallback);
}

/// Whether a residual is no larger than what the last digits of the state decide: no state in double
/// precision is in better balance.
bool Newton::is_rounding(const Vector& at, const Vector& residual, double load_factor) {
  Vector neighbour = at;
  unsigned bits = 1;
  for (double& entry : neighbour) {
    bits = 1664525 * bits + 1013904223; // Numerical Recipes' generator: any signs will do
    entry = std::nextafter(entry, (bits >> 31) != 0 ? INFINITY : -INFINITY);
  }
  const Vector change = problem_.residual(neighbour, load_factor) - residual;
  return problem_.dot(residual, residual) <= 16 * problem_.dot(change, change);
}

bool Newton::fail(const char* reason) {
  failure_ = reason;
  return false;
}

} // namespace springproof::mechanics
