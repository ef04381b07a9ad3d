#include "fem_reference/load_path.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::fem_reference {

namespace {

constexpr int most_iterations = 14;        ///< of Newton in one step: quadratic convergence takes 4 to 8
constexpr int easy_iterations = 6;         ///< a step that took no more is doubled
constexpr int most_total_iterations = 300; ///< of a whole solve
constexpr double smallest_step = 1. / 512;
constexpr double smallest_fraction = 1. / 64; ///< of a Newton correction
/// Work left on a correction after it, of that at its start: it must fall a little at least.
constexpr double accepted_work = 0.9;

bool in_equilibrium(const Imbalance& imbalance, double tolerance) {
  return imbalance.valid && imbalance.residual <= tolerance &&
         imbalance.volume_mismatch <= volume_tolerance && imbalance.prescribed_gap <= 1e-12;
}

enum class Merit { work, validity };

/// A fraction of the correction after which the state is not inverted and, where work is the merit, the
/// imbalance does less work on it.
struct LineSearch {
  Equilibrium& equilibrium;
  const State& start;
  const State& correction;
  double load_factor;
  Merit merit;
  double start_work;

  /// @return the imbalance at the accepted state; not valid when no fraction would do
  Imbalance run(State& state, Wanted wanted) const {
    double fraction = 1;
    Wanted evaluated = wanted;
    while (fraction >= smallest_fraction) {
      equilibrium.copy(start, state);
      equilibrium.advance(state, fraction, correction);
      const Imbalance imbalance = equilibrium.evaluate(state, load_factor, evaluated);
      const double work = imbalance.valid ? equilibrium.work(correction) : 0;
      if (imbalance.valid && acceptable(work)) {
        if (evaluated == wanted) return imbalance;
        return equilibrium.evaluate(state, load_factor, wanted);
      }
      // secant on the work where it changed sign, halving otherwise
      const double secant = imbalance.valid ? start_work / (start_work - work) : 0.5;
      fraction *= std::clamp(secant, 0.2, 0.7);
      evaluated = Wanted::stress;
    }
    return {};
  }
  bool acceptable(double work) const {
    if (merit == Merit::validity) return true;
    // work of the imbalance on the correction: negative at the start; same sign later means the minimum lies
    // beyond
    return std::abs(work) <= accepted_work * std::abs(start_work) || work * start_work > 0;
  }
};

/// Work says nothing about a saddle point (pressure modes), while supports still move, or when one step is
/// exact.
Merit merit_of(const Equilibrium& equilibrium, const Imbalance& imbalance) {
  const bool saddle_point = equilibrium.discretisation().element.pressure == Pressure::modes;
  const bool linear = equilibrium.formulation().kinematics == Kinematics::linear;
  return saddle_point || linear || imbalance.prescribed_gap > 0 ? Merit::validity : Merit::work;
}

} // namespace

NewtonReport newton(Equilibrium& equilibrium, LinearSolver& solver, State& state, double load_factor,
                    double tolerance) {
  NewtonReport report;
  State correction = equilibrium.rest(), start = equilibrium.rest();
  const bool linear = equilibrium.formulation().kinematics == Kinematics::linear;
  Imbalance imbalance = equilibrium.evaluate_for_correction(state, load_factor);
  bool has_tangent = true;
  for (; report.iterations < most_iterations; ++report.iterations) {
    report.residual = imbalance.residual;
    if (!imbalance.valid) {
      report.failure = "cells turn inside out";
      return report;
    }
    if (in_equilibrium(imbalance, tolerance)) {
      report.converged = true;
      return report;
    }
    if (!has_tangent) equilibrium.evaluate_for_correction(state, load_factor);
    const auto solved =
        solver.solve(equilibrium.right_hand_side(), correction.displacement.get(), equilibrium.n_tangents());
    report.linear_iterations += solved.iterations;
    if (!solved.solved) {
      report.failure = "the linear solver failed";
      return report;
    }
    equilibrium.complete_correction(correction);
    equilibrium.copy(state, start);
    // the last correction is expected to be the last when convergence is quadratic: spare the tangent after
    // it
    const bool nearly_done = linear || imbalance.residual <= 1e-5;
    const Wanted wanted = nearly_done ? Wanted::stress : Wanted::stress_and_tangent;
    const LineSearch search{equilibrium,
                            start,
                            correction,
                            load_factor,
                            merit_of(equilibrium, imbalance),
                            equilibrium.work(correction)};
    imbalance = search.run(state, wanted);
    has_tangent = wanted == Wanted::stress_and_tangent;
  }
  report.residual = imbalance.residual;
  report.converged = in_equilibrium(imbalance, tolerance);
  if (!report.converged) report.failure = "Newton's method does not converge";
  return report;
}

NewtonReport carry_load(Equilibrium& equilibrium, LinearSolver& solver, State& state,
                        const LoadSteps& steps) {
  State reached_state = equilibrium.rest(), increment = equilibrium.rest();
  equilibrium.copy(state, reached_state);
  const auto load_factor = [&](double way) { return steps.from + way * (steps.to - steps.from); };
  double reached = 0, step = steps.largest, last_step = 0; // of the way
  NewtonReport whole;
  while (reached < 1) {
    step = std::min(step, 1 - reached);
    // a remainder too small for a step of its own is taken along
    const double target = 1 - reached - step < smallest_step ? 1 : reached + step;
    equilibrium.copy(reached_state, state);
    if (last_step > 0) equilibrium.advance(state, (target - reached) / last_step, increment);
    const NewtonReport report = newton(equilibrium, solver, state, load_factor(target), steps.tolerance);
    whole.iterations += report.iterations;
    whole.linear_iterations += report.linear_iterations;
    whole.residual = report.residual;
    if (report.converged) {
      equilibrium.copy(state, increment);
      equilibrium.advance(increment, -1, reached_state);
      equilibrium.copy(state, reached_state);
      last_step = target - reached;
      reached = target;
      if (report.iterations <= easy_iterations) step = std::min(2 * step, steps.largest);
    } else {
      step = (target - reached) / 2;
    }
    if (step < smallest_step || whole.iterations > most_total_iterations)
      throw cases::SolveError(
          "equilibrium lost at load factor " + std::to_string(load_factor(reached)) + ": " + report.failure,
          load_factor(reached), report.residual, cases::Outcome::unknown, {whole.iterations});
  }
  whole.converged = true;
  return whole;
}

} // namespace springproof::fem_reference
