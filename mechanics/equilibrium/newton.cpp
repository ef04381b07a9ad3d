#include "mechanics/equilibrium/newton.hpp"

#include "mechanics/interruption.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace springproof::mechanics {

namespace {

constexpr double smallest_energy_fraction = 1e-6, smallest_work_fraction = 1. / 64;
/// Largest accepted work after a step, relative to that at its start: it must fall a little.
constexpr double accepted_work = 0.9;

std::atomic<Interruption> interruption{nullptr};

bool search_energy(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                   double load_factor, Trial& trial, Expect expect) {
  const double start = trial.energy ? *trial.energy : problem.energy(at, load_factor),
               slope = problem.dot(step, residual);
  for (double fraction = 1; fraction > smallest_energy_fraction; fraction /= 2) {
    trial.at = at + fraction * step;
    const double energy = problem.energy(trial.at, load_factor), change = energy - start;
    const bool falls = change <= -1e-4 * fraction * slope;
    const bool in_rounding = fraction * slope <= 1e-9 * (std::abs(start) + slope);
    if (!falls && !in_rounding) continue;
    problem.residual(trial.at, load_factor, expect, trial.residual);
    if (!falls && !(problem.dot(trial.residual, trial.residual) < problem.dot(residual, residual))) continue;
    at.swap(trial.at);
    residual.swap(trial.residual);
    trial.energy = energy;
    return true;
  }
  return false;
}

bool search_work(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Trial& trial, Expect expect) {
  const bool any = problem.merit() == Merit::none;
  const double start = problem.dot(step, residual);
  for (double fraction = 1; fraction >= smallest_work_fraction; expect = Expect::residual) {
    trial.at = at + fraction * step;
    problem.residual(trial.at, load_factor, expect, trial.residual);
    const double work = problem.dot(step, trial.residual);
    // Work of the same sign after the step as before it means that the minimum lies beyond.
    if (std::isfinite(work) &&
        (any || std::abs(work) <= accepted_work * std::abs(start) || work * start > 0)) {
      at.swap(trial.at);
      residual.swap(trial.residual);
      return true;
    }
    // Secant on the work where it changed sign, halving otherwise.
    fraction *= std::isfinite(work) ? std::clamp(start / (start - work), 0.2, 0.7) : 0.5;
  }
  return false;
}

} // namespace

void set_interruption(Interruption check) {
  interruption = check;
}

void check_interruption() {
  if (const Interruption check = interruption) check();
}

bool line_search(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Trial& trial, Expect expect) {
  const auto search = problem.merit() == Merit::energy ? search_energy : search_work;
  return search(problem, at, residual, step, load_factor, trial, expect);
}

bool Newton::solve(Vector& at, double load_factor, Convexity fallback, int iteration_factor) {
  if (const auto solved = problem_.solve_at(at, load_factor)) {
    result_.newton_iterations += solved->newton_iterations;
    result_.residual = solved->residual;
    check_limits();
    if (solved->converged) return true;
    // A solver of its own does not know rounding, and stops where no step gains anything.
    problem_.residual(at, load_factor, Expect::residual, residual_);
    return (may_be_rounding(solved->residual) && is_rounding(at, load_factor)) ||
           fail("Newton's method does not converge");
  }
  // Off a saddle the way is long and winds through a narrow valley of the potential.
  const int max_iterations =
      settings_.max_newton_per_step * std::max(iteration_factor, fallback == Convexity::shifted ? 4 : 1);
  const int max_convexified =
      result_.convexified_steps + iteration_factor * settings_.max_convexified_per_step;
  trial_.energy.reset();
  double forcing = settings_.first_forcing, norm_before = 0, norm_at_first = 0;
  problem_.residual(at, load_factor, Expect::direction, residual_);
  for (int iteration = 0;; ++iteration) {
    const NonlinearProblem::Size size = problem_.size(residual_, at);
    const double norm = result_.residual = size.relative;
    if (!std::isfinite(norm)) return fail("cells turn inside out");
    if (norm <= settings_.tolerance && size.constraints_hold) return true;
    if (iteration == settings_.enough_newton_per_step && size.constraints_hold) return true;
    if (iteration == max_iterations || result_.convexified_steps > max_convexified)
      return fail("Newton's method does not converge");
    if (iteration == 0) norm_at_first = norm;
    // A load step that succeeds has gained a hundred times by then; one that wanders goes on wandering. Where
    // an energy falls, the residual may well grow on the way.
    const bool may_wander = settings_.may_wander || problem_.merit() == Merit::energy;
    if (!may_wander && iteration == max_iterations / 2 && norm > 0.1 * norm_at_first)
      return fail("Newton's method does not converge");
    if (norm_before > 0) {
      const double ratio = norm / norm_before;
      forcing = std::min(0.1, 0.9 * ratio * ratio);
      // Close to the solution each step gains much. Where it does not, rounding may be all that is left.
      if (ratio > 0.1 && size.constraints_hold && may_be_rounding(norm) && is_rounding(at, load_factor))
        return true;
    }
    norm_before = norm;
    forcing = std::clamp(forcing, std::min(0.1, 0.3 * settings_.tolerance / norm), 0.1);
    check_limits();
    ++result_.newton_iterations;
    if (!take_step(at, forcing, load_factor, fallback))
      return (size.constraints_hold && may_be_rounding(norm) && is_rounding(at, load_factor)) ||
             fail("no step gets nearer");
  }
}

void Newton::check_limits() const {
  check_interruption();
  if (settings_.should_stop && problem_.any_rank(settings_.should_stop())) throw Stopped{"it was stopped"};
  if (result_.newton_iterations >= settings_.max_newton_iterations)
    throw Stopped{"the limit on Newton iterations was reached"};
}

bool Newton::take_step(Vector& at, double forcing, double load_factor, Convexity fallback) {
  // Where convergence is quadratic the step from here is the last.
  const Expect expect = result_.residual <= 1e-5 ? Expect::residual : Expect::direction;
  const auto take = [&](Convexity convexity) {
    return problem_.direction(at, residual_, load_factor, forcing, convexity, step_) &&
           (take_full_step(at, load_factor, expect) ||
            line_search(problem_, at, residual_, step_, load_factor, trial_, expect));
  };
  if (take(Convexity::exact)) return true;
  if (fallback == Convexity::exact) return false;
  ++result_.convexified_steps;
  return take(fallback);
}

bool Newton::take_full_step(Vector& at, double load_factor, Expect expect) {
  if (!settings_.takes_full_steps) return false;
  trial_.at = at + step_;
  problem_.residual(trial_.at, load_factor, expect, trial_.residual);
  if (!(4 * problem_.dot(trial_.residual, trial_.residual) <= problem_.dot(residual_, residual_)))
    return false;
  at.swap(trial_.at);
  residual_.swap(trial_.residual);
  trial_.energy.reset();
  return true;
}

bool Newton::may_be_rounding(double relative_residual) const {
  return problem_.moves_supports() || relative_residual < 1e-6;
}

/// Whether a residual is no larger than what the last digits of the state decide: no state in double
/// precision is in better balance.
bool Newton::is_rounding(const Vector& at, double load_factor) {
  Vector& neighbour = trial_.at = at;
  unsigned bits = 1;
  const auto next = [&] {
    return bits = 1664525 * bits + 1013904223;
  }; // Numerical Recipes: any signs will do
  problem_.draw(next, neighbour, [](double& entry, unsigned number) {
    entry = std::nextafter(entry, (number >> 31) != 0 ? INFINITY : -INFINITY);
  });
  Vector& change = trial_.residual;
  problem_.residual(neighbour, load_factor, Expect::residual, change);
  change -= residual_;
  return problem_.dot(residual_, residual_) <= 16 * problem_.dot(change, change);
}

bool Newton::fail(const char* reason) {
  failure_ = reason;
  return false;
}

} // namespace springproof::mechanics
