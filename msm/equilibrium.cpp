#include "msm/equilibrium.hpp"

#include "cases/case/error.hpp"
#include "msm/line_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace springproof::msm {

namespace {

class PathFollower {
 public:
  PathFollower(EquilibriumSystem& system, const EquilibriumSettings& settings)
      : system_(system), settings_(settings) {}

  Equilibrium follow(const Vector& start) {
    now_ = previous_ = start;
    system_.move_supports(now_, 0);
    inverted_ = system_.n_inverted(now_);
    if (settings_.stability == Stability::require && start.isZero(0)) check_rest(start);
    double step = settings_.first_load_step;
    if (!start.isZero(0)) {
      leash_ = from_anywhere; // what is nearest need not be near
      if (attempt(now_, std::min(1.0, step), Convexity::clamped)) step = settings_.largest_load_step;
      leash_ = 1;
    }
    if (step == 1 && settings_.guess && !system_.moves_supports())
      attempt(*settings_.guess, 1, Convexity::exact);
    for (int n = 0; result_.load_reached < 1; ++n) {
      if (n == settings_.max_load_steps) give_up("the limit on load steps was reached");
      if (step < settings_.smallest_load_step)
        give_up("no equilibrium was found beyond this load", cases::Outcome::limit_point);
      const double target = std::min(1.0, result_.load_reached + step);
      const int iterations_before = result_.newton_iterations;
      // Close to a limit point nothing but the tangent's sign tells that the path ends: there a convexified
      // step would leave the path.
      const bool stays_convex = step < small_step || settings_.max_convexified_per_step == 0;
      if (!attempt(predicted(target), target, stays_convex ? Convexity::exact : Convexity::clamped))
        step /= 2;
      else if (result_.newton_iterations - iterations_before <= 8) // an easy step
        step = std::min(2 * step, settings_.largest_load_step);
    }
    return finish();
  }

 private:
  static constexpr double small_step = 1.0 / 32;
  static constexpr int from_anywhere = 10; ///< the leash of a start that is no equilibrium

  EquilibriumSystem& system_;
  const EquilibriumSettings& settings_;
  Equilibrium result_;
  Vector now_, previous_;    ///< the last two equilibria on the path
  double previous_step_ = 0; ///< between their loads; 0: there is one alone
  int inverted_ = 0;         ///< cells, now
  int leash_ = 1;            ///< how many times the usual number of iterations one load step may take

  Vector extrapolated(double target) const {
    if (!(previous_step_ > 0)) return now_;
    return now_ + ((target - result_.load_reached) / previous_step_) * (now_ - previous_);
  }

  /// What a load step starts from. Supports that move take the body along as far as the tangent knows: moved
  /// alone, they would turn the cells next to them inside out.
  Vector predicted(double target) {
    Vector trial = extrapolated(target);
    if (!system_.moves_supports()) return trial;
    Vector there = trial;
    system_.move_supports(there, target);
    const Vector gap = there - trial;
    const double largest = gap.cwiseAbs().maxCoeff();
    if (!(largest > 0)) return there;
    constexpr double small = 1e-7; // mm: differences of forces then keep half of their digits
    const Vector pull = (largest / small) * (system_.imbalance(trial + (small / largest) * gap, target) -
                                             system_.imbalance(trial, target));
    if (const auto step = system_.direction(trial, pull, 1e-3, Convexity::exact)) there += *step;
    return there;
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

  /// Without load the body must resist every motion.
  void check_rest(const Vector& rest) {
    if (system_.is_mechanism())
      give_up("some motion of the lattice at rest meets no stiffness", cases::Outcome::mechanism);
    if (!system_.is_stable(rest))
      give_up("the lattice is unstable at rest, because of springs of negative stiffness",
              cases::Outcome::unstable_equilibrium);
  }

  bool take_step(Vector& at, const Vector& imbalance, double forcing, double load_factor,
                 Convexity fallback) {
    auto step = system_.direction(at, imbalance, forcing, Convexity::exact);
    if (step && line_search(system_, at, *step, imbalance, load_factor)) return true;
    if (fallback == Convexity::exact) return false;
    ++result_.convexified_steps;
    step = system_.direction(at, imbalance, forcing, fallback);
    return step && line_search(system_, at, *step, imbalance, load_factor);
  }

  /// Whether an imbalance is no larger than what the last digits of the displacement decide: no displacement
  /// in double precision is in better balance. Supports that move without straining the body leave no
  /// reaction to compare with.
  bool is_rounding(const Vector& at, const Vector& imbalance, double load_factor) {
    if (!system_.moves_supports() && !(relative_imbalance(system_, imbalance, at) < 1e-6)) return false;
    Vector neighbour = at;
    unsigned bits = 1;
    for (double& entry : neighbour) {
      bits = 1664525 * bits + 1013904223; // Numerical Recipes' generator: any signs will do
      entry = std::nextafter(entry, (bits >> 31) != 0 ? INFINITY : -INFINITY);
    }
    return imbalance.norm() <= 4 * (system_.imbalance(neighbour, load_factor) - imbalance).norm();
  }

  /// Newton at one load. On success `at` is in balance; otherwise it is of no use. The forcing is choice 2 of
  /// Eisenstat and Walker (1996), gamma = 0.9, alpha = 2, never tighter than what the tolerance asks for.
  bool newton(Vector& at, double load_factor, Convexity fallback) {
    double forcing = 0.1, norm_before = 0;
    // Off a saddle the way is long and winds through a narrow valley of the potential.
    const int max_iterations =
        settings_.max_newton_per_step * std::max(leash_, fallback == Convexity::shifted ? 4 : 1);
    const int allowed = result_.convexified_steps + leash_ * settings_.max_convexified_per_step;
    for (int iteration = 0; iteration <= max_iterations; ++iteration) {
      const Vector imbalance = system_.imbalance(at, load_factor);
      const double norm = relative_imbalance(system_, imbalance, at);
      if (!std::isfinite(norm)) return false;
      if (norm <= settings_.tolerance) return true;
      if (iteration == max_iterations || result_.convexified_steps > allowed) return false;
      if (norm_before > 0) {
        const double ratio = norm / norm_before;
        forcing = std::min(0.1, 0.9 * ratio * ratio);
      }
      // Close to the solution each step gains much. Where it does not, rounding may be all that is left.
      if (norm_before > 0 && norm > 0.1 * norm_before && is_rounding(at, imbalance, load_factor)) return true;
      norm_before = norm;
      forcing = std::clamp(forcing, std::min(0.1, 0.3 * settings_.tolerance / norm), 0.1);
      if (settings_.should_stop && settings_.should_stop()) give_up("it was stopped");
      if (result_.newton_iterations == settings_.max_newton_iterations)
        give_up("the limit on Newton iterations was reached");
      ++result_.newton_iterations;
      if (!take_step(at, imbalance, forcing, load_factor, fallback))
        return is_rounding(at, imbalance, load_factor);
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
    result_.residual = relative_imbalance(system_, system_.imbalance(now_, 1), now_);
    result_.is_stable = settings_.stability == Stability::require; // every step was settled
    result_.lowest_eigenvalue = lowest_eigenvalue();
    result_.displacement = std::move(now_);
    return result_;
  }

  std::optional<double> lowest_eigenvalue() {
    if (settings_.lowest_eigenvalue == LowestEigenvalue::skip) return std::nullopt;
    return system_.lowest_mode(now_).eigenvalue;
  }

  [[noreturn]] void give_up(const std::string& reason, cases::Outcome outcome = cases::Outcome::unknown) {
    throw cases::SolveError("mass-spring equilibrium: " + reason, result_.load_reached,
                            relative_imbalance(system_, system_.imbalance(now_, result_.load_reached), now_),
                            outcome, {result_.newton_iterations, lowest_eigenvalue(), inverted_});
  }
};

} // namespace

Equilibrium find_equilibrium(EquilibriumSystem& system, const Vector& start,
                             const EquilibriumSettings& settings) {
  return PathFollower(system, settings).follow(start);
}

} // namespace springproof::msm
