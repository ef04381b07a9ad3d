#include "mechanics/equilibrium/line_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::mechanics {

namespace {

constexpr double smallest_energy_fraction = 1e-6, smallest_work_fraction = 1. / 64;
/// Work left on a step after it, of that at its start: it must fall a little at least.
constexpr double accepted_work = 0.9;

bool search_energy(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                   double load_factor, Expect expect) {
  const double start = problem.energy(at, load_factor), slope = problem.dot(step, residual);
  for (double fraction = 1; fraction > smallest_energy_fraction; fraction /= 2) {
    Vector trial = at + fraction * step;
    const double change = problem.energy(trial, load_factor) - start;
    const bool falls = change <= -1e-4 * fraction * slope;
    const bool in_rounding = fraction * slope <= 1e-9 * (std::abs(start) + slope);
    if (!falls && !in_rounding) continue;
    Vector found = problem.residual(trial, load_factor, expect);
    if (!falls && !(problem.dot(found, found) < problem.dot(residual, residual))) continue;
    at = std::move(trial);
    residual = std::move(found);
    return true;
  }
  return false;
}

bool search_work(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Expect expect) {
  const bool any = problem.merit() == Merit::none;
  const double start = problem.dot(step, residual);
  for (double fraction = 1; fraction >= smallest_work_fraction; expect = Expect::residual) {
    Vector trial = at + fraction * step;
    Vector found = problem.residual(trial, load_factor, expect);
    const double work = problem.dot(step, found);
    // Work of the same sign after the step as before it means that the minimum lies beyond.
    if (std::isfinite(work) &&
        (any || std::abs(work) <= accepted_work * std::abs(start) || work * start > 0)) {
      at = std::move(trial);
      residual = std::move(found);
      return true;
    }
    // Secant on the work where it changed sign, halving otherwise.
    fraction *= std::isfinite(work) ? std::clamp(start / (start - work), 0.2, 0.7) : 0.5;
  }
  return false;
}

} // namespace

bool line_search(NonlinearProblem& problem, Vector& at, Vector& residual, const Vector& step,
                 double load_factor, Expect expect) {
  const auto search = problem.merit() == Merit::energy ? search_energy : search_work;
  return search(problem, at, residual, step, load_factor, expect);
}

} // namespace springproof::mechanics
