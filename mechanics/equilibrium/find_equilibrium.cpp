#include "mechanics/equilibrium/find_equilibrium.hpp"

#include "cases/case/case.hpp"
#include "mechanics/equilibrium/newton.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace springproof::mechanics {

namespace {

class PathFollower {
 public:
  PathFollower(NonlinearProblem& problem, const std::string& name, const EquilibriumSettings& settings)
      : problem_(problem), name_(name), settings_(settings), newton_(problem, settings, result_) {}

  Equilibrium follow(const Vector& start) {
    try {
      go(start);
    } catch (const Newton::Stopped& stopped) {
      give_up(stopped.reason);
    }
    if (settings_.stability == Stability::report) result_.is_stable = problem_.is_stable(now_);
    finish();
    result_.state = std::move(now_);
    return std::move(result_);
  }

 private:
  static constexpr double small_step = 1.0 / 32;
  static constexpr int guess_factor = 10; ///< multiplies the iteration limit of a start out of equilibrium

  NonlinearProblem& problem_;
  const std::string& name_;
  const EquilibriumSettings& settings_;
  const NonlinearProblem::Work before_ = problem_.work();
  Equilibrium result_;
  Newton newton_;
  double reached_ = 0;       ///< fraction of the way
  Vector now_, previous_;    ///< the last two equilibria on the path
  double previous_step_ = 0; ///< way between them; 0: there is only one
  int inverted_ = 0;         ///< inverted cells at now_
  bool is_blocked_ = false;  ///< the last step failed because its way was not open

  double load(double way) const { return settings_.from + way * (settings_.to - settings_.from); }

  void go(const Vector& start) {
    now_ = previous_ = start;
    problem_.move_supports(now_, load(0));
    inverted_ = problem_.n_inverted(now_);
    double step = settings_.first_load_step;
    if (settings_.from == 0) {
      const bool is_rest = problem_.dot(start, start) == 0;
      if (is_rest && settings_.stability == Stability::require) check_rest();
      if (!is_rest && attempt(now_, std::min(1.0, step), Convexity::clamped, guess_factor))
        step = settings_.largest_load_step;
      else if (!is_rest)
        check_start();
    }
    if (step == 1 && settings_.guess && !problem_.moves_supports())
      attempt(*settings_.guess, 1, Convexity::exact);
    for (int n = 0; reached_ < 1; ++n) {
      if (n == settings_.max_load_steps) give_up("the limit on load steps was reached");
      if (step < settings_.smallest_load_step) give_up_path();
      // A remainder too small for a step of its own is taken along.
      const double target = 1 - reached_ - step < settings_.smallest_load_step ? 1 : reached_ + step;
      const int iterations_before = result_.newton_iterations;
      // Close to a limit point only the tangent's sign shows that the path ends. A convexified step would
      // leave the path there.
      const bool stays_convex = step < small_step || settings_.max_convexified_per_step == 0;
      if (!attempt(predicted(target), target, stays_convex ? Convexity::exact : Convexity::clamped))
        step /= 2;
      else if (result_.newton_iterations - iterations_before <= settings_.easy_newton_per_step)
        step = std::min(2 * step, settings_.largest_load_step);
    }
  }

  /// Returns the start of a load step: the last increment extrapolated. Supports that move take the body
  /// along as far as the tangent knows: moved alone, they would turn the cells next to them inside out.
  Vector predicted(double target) {
    Vector trial = now_;
    if (previous_step_ > 0) trial += ((target - reached_) / previous_step_) * (now_ - previous_);
    if (!problem_.moves_supports()) return trial;
    const double at_load = load(target);
    Vector there = trial;
    problem_.move_supports(there, at_load);
    const Vector gap = there - trial;
    const double largest = problem_.largest(gap);
    if (!(largest > 0)) return there;
    constexpr double small = 1e-7; // mm: differences of forces then keep half of their digits
    const Vector pull = (largest / small) * (problem_.residual(trial + (small / largest) * gap, at_load) -
                                             problem_.residual(trial, at_load));
    if (const auto step = problem_.direction(trial, pull, at_load, 1e-3, Convexity::exact)) there += *step;
    return there;
  }

  /// Tries one load step. On success the path goes on from its end.
  bool attempt(Vector trial, double target, Convexity fallback, int iteration_factor = 1) {
    const int left_convexity = result_.escapes + result_.convexified_steps;
    is_blocked_ = false;
    if (!newton_.solve(trial, load(target), fallback, iteration_factor)) return false;
    if (settings_.stability == Stability::require && !settle(trial, load(target))) return false;
    const int inverted = problem_.n_inverted(trial);
    const bool may_have_jumped = result_.escapes + result_.convexified_steps > left_convexity;
    if (inverted > inverted_ && may_have_jumped) return false;
    is_blocked_ = settings_.is_way_open && !settings_.is_way_open(now_, load(reached_), trial, load(target));
    if (is_blocked_) return false;
    previous_ = std::exchange(now_, std::move(trial));
    previous_step_ = target - reached_;
    inverted_ = inverted;
    reached_ = target;
    ++result_.load_steps;
    return true;
  }

  /// A start with inverted cells may have no forces.
  void check_start() {
    if (std::isfinite(problem_.size(problem_.residual(now_, load(0)), now_).relative)) return;
    cases::Solution none;
    none.unknowns = problem_.n_unknowns();
    none.inverted_cells = inverted_;
    none.outcome = cases::Outcome::refused;
    throw cases::SolveError(name_ + ": the start has cells turned inside out, where the law has no forces",
                            std::move(none));
  }

  /// Checks that the body resists every motion without load.
  void check_rest() {
    const RestState rest = problem_.rest_state();
    if (rest == RestState::mechanism)
      give_up("some motion of the lattice at rest meets no stiffness", cases::Outcome::mechanism);
    if (rest == RestState::unstable)
      give_up("the lattice is unstable at rest" + problem_.cause_of_instability(),
              cases::Outcome::unstable_equilibrium);
    if (rest == RestState::unknown) give_up("the linear solver fails already at rest");
  }

  /// Leaves an unstable equilibrium for a stable one: a push along the lowest mode, whichever way its first
  /// large entry says, as far as the energy falls, and Newton from there.
  bool settle(Vector& at, double load_factor) {
    for (int attempt = 0; attempt < 3; ++attempt) {
      result_.is_stable = problem_.is_stable(at);
      if (result_.is_stable.value_or(true)) return true;
      const auto mode = problem_.lowest_mode(at);
      if (!mode) return false;
      result_.is_stable = true;
      if (!(mode->eigenvalue < 0)) return true;
      ++result_.escapes;
      const double unit = 1 / problem_.largest(mode->shape); // to 1 mm at most
      double lowest = problem_.energy(at, load_factor);
      Vector best;
      for (double size = 1e-3; size <= 10; size *= 2) {
        Vector trial = at + (size * unit) * mode->shape;
        const double energy = problem_.energy(trial, load_factor);
        if (!(energy < lowest)) break;
        lowest = energy;
        best = std::move(trial);
      }
      if (best.size() == 0 || !newton_.solve(best, load_factor, Convexity::shifted)) return false;
      at = std::move(best);
    }
    result_.is_stable = problem_.is_stable(at);
    return result_.is_stable.value_or(true);
  }

  /// Records what is known of the last equilibrium, and the work.
  void finish() {
    if (settings_.lowest_eigenvalue == LowestEigenvalue::report)
      if (const auto mode = problem_.lowest_mode(now_)) result_.lowest_eigenvalue = mode->eigenvalue;
    result_.load_reached = load(reached_);
    result_.n_unknowns = problem_.n_unknowns();
    result_.work = problem_.work() - before_;
  }

  /// Reports a limit point if every equilibrium was stable; otherwise the cause is not known.
  [[noreturn]] void give_up_path() {
    const std::string reason = "no equilibrium was found beyond this load";
    if (is_blocked_) give_up(reason + ": in the shortest load step a node still goes through a tool");
    if (settings_.stability == Stability::require) give_up(reason, cases::Outcome::limit_point);
    give_up(reason + ": " + newton_.failure());
  }

  [[noreturn]] void give_up(const std::string& reason, cases::Outcome outcome = cases::Outcome::unknown) {
    result_.residual = problem_.size(problem_.residual(now_, load(reached_)), now_).relative;
    finish();
    cases::Solution so_far = to_solution(result_);
    so_far.outcome = outcome;
    so_far.inverted_cells = inverted_;
    throw cases::SolveError(name_ + ": " + reason, std::move(so_far));
  }
};

} // namespace

Equilibrium find_equilibrium(NonlinearProblem& problem, const Vector& start, const std::string& name,
                             const EquilibriumSettings& settings) {
  return PathFollower(problem, name, settings).follow(start);
}

Equilibrium prescribed_state(const NonlinearProblem& problem, const Vector& start,
                             const EquilibriumSettings& settings) {
  Equilibrium result;
  result.state = start;
  problem.move_supports(result.state, settings.to);
  result.load_reached = settings.to;
  result.load_steps = 1;
  if (settings.stability != Stability::ignore) result.is_stable = true;
  return result;
}

cases::Solution to_solution(const Equilibrium& equilibrium) {
  cases::Solution solution;
  solution.status = cases::Status::converged;
  if (equilibrium.is_stable)
    solution.outcome =
        *equilibrium.is_stable ? cases::Outcome::stable_equilibrium : cases::Outcome::unstable_equilibrium;
  solution.unknowns = equilibrium.n_unknowns;
  solution.residual = equilibrium.residual;
  solution.load_reached = equilibrium.load_reached;
  solution.newton_iterations = equilibrium.newton_iterations;
  solution.relaxation_iterations = equilibrium.relaxation_iterations;
  solution.linear_iterations = equilibrium.work.linear_iterations;
  solution.force_evaluations = equilibrium.work.force_evaluations;
  solution.factorisations = equilibrium.work.factorisations;
  solution.lowest_eigenvalue = equilibrium.lowest_eigenvalue;
  return solution;
}

EquilibriumSettings in_small_turns(double degrees, int at_least, EquilibriumSettings settings) {
  const double way = std::abs(settings.to - settings.from);
  const double n_steps = std::max(std::ceil(std::abs(degrees) * way / cases::largest_turn_of_step),
                                  std::ceil(at_least * way - 1e-9));
  if (!(n_steps > 1)) return settings;
  for (double* step : {&settings.first_load_step, &settings.largest_load_step})
    *step = std::min(*step, 1 / n_steps);
  // Some halvings must be left.
  settings.smallest_load_step = std::min(settings.smallest_load_step, settings.largest_load_step / 16);
  // The limits are for paths that may be one step: as many steps as are asked for must not meet them.
  const int n_asked = std::max(0, static_cast<int>(std::ceil(at_least * way - 1e-9)) - 1);
  settings.max_load_steps += n_asked;
  settings.max_newton_iterations += n_asked * settings.easy_newton_per_step;
  return settings;
}

} // namespace springproof::mechanics
