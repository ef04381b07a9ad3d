#include "msm/relaxation/relaxation.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "mechanics/equilibrium/newton.hpp"
#include "mechanics/interruption.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <utility>

namespace springproof::msm {

namespace {

using mechanics::NonlinearProblem;
using mechanics::Vector;

/// One explicit iteration at some load factor: moves `at`, where the residual is `force`, and evaluates the
/// next.
/// @return false when there is no way on
using Method = std::function<bool(Vector& at, Vector& force)>;

/// Largest eigenvalue of the tangent (N/mm), by the power method on differences of forces.
double largest_eigenvalue(NonlinearProblem& problem, double load_factor, const Vector& at,
                          const Vector& force) {
  constexpr int n_iterations = 40;
  constexpr double small = 1e-6; // mm
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  Vector mode(at.size());
  for (double& entry : mode) entry = normal(generator);
  double eigenvalue = 0;
  for (int n = 0; n < n_iterations; ++n) {
    // What the first image leaves out are the entries that are not free.
    const Vector image = (force - problem.residual(at + (small / mode.norm()) * mode, load_factor)) / small;
    eigenvalue = image.norm();
    if (!(eigenvalue > 0)) return 1;
    mode = image;
  }
  return eigenvalue;
}

Method force_scaling(NonlinearProblem& problem, double load_factor, double eigenvalue) {
  return [&problem, load_factor, alpha = 1 / eigenvalue](Vector& at, Vector& force) { // alpha: mm/N
    at += alpha * force;
    force = problem.residual(at, load_factor);
    return true;
  };
}

class Fire {
 public:
  Fire(NonlinearProblem& problem, double load_factor, double eigenvalue)
      : problem_(problem), load_factor_(load_factor), longest_(1 / std::sqrt(eigenvalue)), // all masses 1
        time_step_(0.1 * longest_) {}

  bool operator()(Vector& at, Vector& force) {
    if (velocity_.size() == 0) velocity_ = Vector::Zero(at.size());
    const double power = force.dot(velocity_);
    if (power > 0) {
      velocity_ = (1 - mixing_) * velocity_ + mixing_ * velocity_.norm() / force.norm() * force;
      if (++n_downhill_ > 5) {
        time_step_ = std::min(1.1 * time_step_, longest_);
        mixing_ *= 0.99;
      }
    } else {
      velocity_.setZero();
      time_step_ *= 0.5;
      mixing_ = first_mixing;
      n_downhill_ = 0;
    }
    velocity_ += time_step_ * force;
    at += time_step_ * velocity_;
    force = problem_.residual(at, load_factor_);
    return true;
  }

 private:
  static constexpr double first_mixing = 0.1;
  NonlinearProblem& problem_;
  double load_factor_, longest_, time_step_, mixing_ = first_mixing;
  int n_downhill_ = 0;
  Vector velocity_;
};

class Lbfgs {
 public:
  Lbfgs(NonlinearProblem& problem, double load_factor, double eigenvalue)
      : problem_(problem), load_factor_(load_factor), scale_(1 / eigenvalue) {}

  bool operator()(Vector& at, Vector& force) {
    if (last_at_.size() > 0) remember(at - last_at_, last_force_ - force);
    last_at_ = at;
    last_force_ = force;
    if (line_search(problem_, at, force, direction(force), load_factor_, trial_)) return true;
    pairs_.clear(); // what was learnt here misleads: once more along the force alone
    return line_search(problem_, at, force, scale_ * force, load_factor_, trial_);
  }

 private:
  static constexpr std::size_t n_pairs = 10;
  struct Pair {
    Vector move, change; ///< mm; of the potential's gradient, N
    double product;
  };
  NonlinearProblem& problem_;
  double load_factor_;
  double scale_; ///< mm/N
  Vector last_at_, last_force_;
  mechanics::Trial trial_;
  std::deque<Pair> pairs_;

  void remember(const Vector& move, const Vector& change) {
    const double product = move.dot(change);
    if (!(product > 1e-12 * move.norm() * change.norm())) return; // no curvature to learn from
    pairs_.push_back({move, change, product});
    if (pairs_.size() > n_pairs) pairs_.pop_front();
    scale_ = product / change.squaredNorm();
  }

  Vector direction(const Vector& force) const {
    Vector result = force;
    std::vector<double> weights;
    for (auto pair = pairs_.rbegin(); pair != pairs_.rend(); ++pair) {
      weights.push_back(pair->move.dot(result) / pair->product);
      result -= weights.back() * pair->change;
    }
    result *= scale_;
    for (const Pair& pair : pairs_) {
      result += (weights.back() - pair.change.dot(result) / pair.product) * pair.move;
      weights.pop_back();
    }
    return result;
  }
};

Method make_method(cases::Solver method, NonlinearProblem& problem, double load_factor, double eigenvalue) {
  if (method == cases::Solver::force_scaling) return force_scaling(problem, load_factor, eigenvalue);
  if (method == cases::Solver::fire) return Fire(problem, load_factor, eigenvalue);
  return Lbfgs(problem, load_factor, eigenvalue);
}

[[noreturn]] void give_up(const NonlinearProblem& problem, const NonlinearProblem::Work& before,
                          mechanics::Equilibrium result, cases::Solver method, const std::string& reason) {
  result.work = problem.work() - before;
  throw cases::SolveError("mass-spring equilibrium by " + cases::name_of(method) + ": " + reason,
                          mechanics::to_solution(result));
}

} // namespace

mechanics::Equilibrium relax_for(NonlinearProblem& problem, const Vector& start,
                                 const cases::RelaxationCounts& counts,
                                 const mechanics::EquilibriumSettings& settings) {
  const NonlinearProblem::Work before = problem.work();
  mechanics::Equilibrium result;
  result.n_unknowns = problem.n_unknowns();
  const auto stop = [&](const std::string& reason) {
    give_up(problem, before, result, cases::Solver::force_scaling, reason);
  };
  Vector at = start, force = problem.residual(at, 0);
  const double alpha = 1 / largest_eigenvalue(problem, 0, at, force); // mm/N
  for (int step = 1; step <= counts.load_steps; ++step) {
    const bool is_last = step == counts.load_steps;
    result.load_reached = step / static_cast<double>(counts.load_steps);
    problem.move_supports(at, result.load_reached);
    const int n_iterations = counts.per_step + (is_last ? counts.further : 0);
    for (int n = 0; n < n_iterations; ++n, ++result.relaxation_iterations) {
      problem.residual(at, result.load_reached, mechanics::Expect::residual, force);
      at.noalias() += alpha * force; // eq. 2.11
      mechanics::check_interruption();
      if (settings.should_stop && settings.should_stop()) stop("it was stopped");
    }
    ++result.load_steps;
  }
  problem.residual(at, 1, mechanics::Expect::residual, force);
  result.residual = problem.size(force, at).relative;
  if (!std::isfinite(result.residual)) stop("it diverges");
  result.state = std::move(at);
  result.work = problem.work() - before;
  return result;
}

mechanics::Equilibrium relax(NonlinearProblem& problem, const Vector& start, cases::Solver method,
                             const mechanics::EquilibriumSettings& settings) {
  constexpr double on_the_way = 1e-3; ///< tolerance of load steps but the last
  const NonlinearProblem::Work before = problem.work();
  mechanics::Equilibrium result;
  result.n_unknowns = problem.n_unknowns();
  const auto stop = [&](const std::string& reason) { give_up(problem, before, result, method, reason); };
  Vector at = start, previous = start;
  const double n_steps = std::ceil(1 / settings.first_load_step);
  for (double n = 1; n <= n_steps; ++n) {
    const double load_factor = n / n_steps,
                 tolerance = n < n_steps ? std::max(settings.tolerance, on_the_way) : settings.tolerance;
    Vector next = 2 * at - previous; // the last increment extrapolated
    previous = std::exchange(at, std::move(next));
    problem.move_supports(at, load_factor);
    Vector force = problem.residual(at, load_factor);
    const Method step =
        make_method(method, problem, load_factor, largest_eigenvalue(problem, load_factor, at, force));
    for (;; ++result.relaxation_iterations) {
      result.residual = problem.size(force, at).relative;
      if (!std::isfinite(result.residual)) stop("it diverges");
      if (result.residual <= tolerance) break;
      if (result.relaxation_iterations == settings.max_relaxation_iterations)
        stop("the limit of " + std::to_string(settings.max_relaxation_iterations) +
             " iterations was reached");
      mechanics::check_interruption();
      if (settings.should_stop && settings.should_stop()) stop("it was stopped");
      if (!step(at, force)) stop("no step lowers the potential");
    }
    result.load_reached = load_factor;
    ++result.load_steps;
  }
  if (settings.stability != mechanics::Stability::ignore) result.is_stable = problem.is_stable(at);
  if (settings.lowest_eigenvalue == mechanics::LowestEigenvalue::report)
    if (const auto mode = problem.lowest_mode(at)) result.lowest_eigenvalue = mode->eigenvalue;
  result.state = std::move(at);
  result.work = problem.work() - before;
  return result;
}

} // namespace springproof::msm
