#include "msm/equilibrium.hpp"

#include "cases/error.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace msm {

namespace {

class LoadPath {
 public:
  LoadPath(EquilibriumSystem& system, const EquilibriumSettings& settings)
      : system_(system), settings_(settings), load_norm_(system.load().norm()) {}

  Equilibrium follow(const Vector& start) {
    now_ = previous_ = start;
    inverted_ = system_.n_inverted(start);
    if (settings_.stability == Stability::require && start.isZero(0)) check_rest(start);
    double step = settings_.first_load_step;
    if (step == 1 && settings_.guess) attempt(*settings_.guess, 1, Convexity::exact);
    for (int n = 0; result_.load_reached < 1; ++n) {
      if (n == settings_.max_load_steps) give_up("the limit on load steps was reached");
      if (step < settings_.smallest_load_step)
        give_up("no equilibrium was found beyond this load", cases::Outcome::limit_point);
      const double target = std::min(1.0, result_.load_reached + step);
      const int iterations_before = result_.newton_iterations;
      // Close to a limit point nothing but the tangent's sign tells that the path ends: there a convexified
      // step would leave the path.
      const bool stays_convex = step < small_step || settings_.max_convexified_per_step == 0;
      if (!attempt(extrapolated(target), target, stays_convex ? Convexity::exact : Convexity::clamped))
        step /= 2;
      else if (result_.newton_iterations - iterations_before <= 8) // an easy step
        step = std::min(2 * step, settings_.largest_load_step);
    }
    return finish();
  }

 private:
  static constexpr double small_step = 1.0 / 32;

  EquilibriumSystem& system_;
  const EquilibriumSettings& settings_;
  const double load_norm_;
  Equilibrium result_;
  Vector now_, previous_;    ///< the last two equilibria on the path
  double previous_step_ = 0; ///< between their loads; 0: there is one alone
  int inverted_ = 0;         ///< cells, now

  Vector extrapolated(double target) const {
    if (!(previous_step_ > 0)) return now_;
    return now_ + ((target - result_.load_reached) / previous_step_) * (now_ - previous_);
  }

  /// One load step. On success the path goes on from its end.
  bool attempt(Vector trial, double target, Convexity fallback) {
    const double step = target - result_.load_reached;
    const int left_convexity = result_.escapes + result_.convexified_steps;
    if (!newton(trial, target, fallback)) return false;
    if (settings_.stability == Stability::require && !settle(trial, target)) return false;
    const int inverted = system_.n_inverted(trial);
    const bool may_have_jumped = result_.escapes + result_.convexified_steps > left_convexity;
    if (inverted > inverted_ && may_have_jumped) return false;
    previous_ = std::exchange(now_, std::move(trial));
    previous_step_ = step;
    inverted_ = inverted;
    result_.load_reached = target;
    ++result_.load_steps;
    return true;
  }

  double relative(const Vector& imbalance) const {
    return imbalance.norm() / (load_norm_ > 0 ? load_norm_ : 1.0);
  }

  /// Without load the body must resist every motion.
  void check_rest(const Vector& rest) {
    if (system_.is_mechanism())
      throw cases::SolveError(
          "mass-spring equilibrium: some motion of the lattice at rest meets no stiffness", 0, 1,
          cases::Outcome::mechanism);
    if (!system_.is_stable(rest))
      throw cases::SolveError("mass-spring equilibrium: the lattice is unstable at rest, because of springs "
                              "of negative stiffness",
                              0, 1, cases::Outcome::unstable_equilibrium);
  }

  /// Moves along the step as far as the potential falls enough (Armijo). Next to the solution the potential's
  /// change drowns in rounding: there a falling imbalance decides.
  bool line_search(Vector& at, const Vector& step, const Vector& before, double load_factor) {
    const double start = system_.potential(at, load_factor);
    const double slope = step.dot(before);
    for (double factor = 1; factor > 1e-6; factor /= 2) {
      Vector trial = at + factor * step;
      const double change = system_.potential(trial, load_factor) - start;
      const bool in_rounding = factor * slope <= 1e-9 * (std::abs(start) + slope);
      if (change <= -1e-4 * factor * slope ||
          (in_rounding && system_.imbalance(trial, load_factor).norm() < before.norm())) {
        at = std::move(trial);
        return true;
      }
    }
    return false;
  }

  bool take_step(Vector& at, const Vector& imbalance, double forcing, double load_factor,
                 Convexity fallback) {
    auto step = system_.direction(at, imbalance, forcing, Convexity::exact);
    if (step && line_search(at, *step, imbalance, load_factor)) return true;
    if (fallback == Convexity::exact) return false;
    ++result_.convexified_steps;
    step = system_.direction(at, imbalance, forcing, fallback);
    return step && line_search(at, *step, imbalance, load_factor);
  }

  /// Newton at one load. On success `at` is in balance; otherwise it is of no use. The forcing is choice 2 of
  /// Eisenstat and Walker (1996), gamma = 0.9, alpha = 2, never tighter than what the tolerance asks for.
  bool newton(Vector& at, double load_factor, Convexity fallback) {
    double forcing = 0.1, norm_before = 0;
    // Off a saddle the way is long and winds through a narrow valley of the potential.
    const int max_iterations = settings_.max_newton_per_step * (fallback == Convexity::shifted ? 4 : 1);
    const int allowed = result_.convexified_steps + settings_.max_convexified_per_step;
    for (int iteration = 0; iteration <= max_iterations; ++iteration) {
      const Vector imbalance = system_.imbalance(at, load_factor);
      const double norm = relative(imbalance);
      if (!std::isfinite(norm)) return false;
      if (norm <= settings_.tolerance) return true;
      if (iteration == max_iterations || result_.convexified_steps > allowed) return false;
      if (norm_before > 0) {
        const double ratio = norm / norm_before;
        forcing = std::min(0.1, 0.9 * ratio * ratio);
      }
      norm_before = norm;
      forcing = std::clamp(forcing, std::min(0.1, 0.3 * settings_.tolerance / norm), 0.1);
      ++result_.newton_iterations;
      if (!take_step(at, imbalance, forcing, load_factor, fallback)) return false;
    }
    return false;
  }

  /// Leaves an unstable equilibrium for a stable one: a push along the lowest mode, whichever way its first
  /// large entry says, as far as the potential falls, and Newton from there.
  bool settle(Vector& at, double load_factor) {
    for (int attempt = 0; attempt < 3; ++attempt) {
      if (system_.is_stable(at)) return true;
      const EquilibriumSystem::Mode mode = system_.lowest_mode(at);
      if (!(mode.eigenvalue < 0)) return true;
      ++result_.escapes;
      const double start = system_.potential(at, load_factor);
      const double unit = 1 / mode.shape.cwiseAbs().maxCoeff(); // to 1 mm at most
      Vector best;
      double lowest = start;
      for (double size = 1e-3; size <= 10; size *= 2) {
        Vector trial = at + (size * unit) * mode.shape;
        const double potential = system_.potential(trial, load_factor);
        if (!(potential < lowest)) break;
        lowest = potential;
        best = std::move(trial);
      }
      if (best.size() == 0 || !newton(best, load_factor, Convexity::shifted)) return false;
      at = std::move(best);
    }
    return system_.is_stable(at);
  }

  Equilibrium finish() {
    result_.residual = relative(system_.imbalance(now_, 1));
    result_.is_stable = settings_.stability == Stability::require; // every step was settled
    if (settings_.lowest_eigenvalue == LowestEigenvalue::report)
      result_.lowest_eigenvalue = system_.lowest_mode(now_).eigenvalue;
    result_.displacement = std::move(now_);
    return result_;
  }

  [[noreturn]] void give_up(const std::string& reason, cases::Outcome outcome = cases::Outcome::unknown) {
    throw cases::SolveError("mass-spring equilibrium: " + reason, result_.load_reached,
                            relative(system_.imbalance(now_, result_.load_reached)), outcome);
  }
};

} // namespace

Equilibrium find_equilibrium(EquilibriumSystem& system, const Vector& start,
                             const EquilibriumSettings& settings) {
  return LoadPath(system, settings).follow(start);
}

} // namespace msm
