#include "msm/relaxation/relaxation.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "msm/line_search.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <random>

namespace springproof::msm {

namespace {

/// One explicit iteration after the other, at full load.
class Method {
 public:
  virtual ~Method() = default;
  /// Moves `at`, where the imbalance is `force`.  @return false when there is no way on
  virtual bool step(Vector& at, const Vector& force) = 0;
};

/// Largest eigenvalue of the tangent (N/mm), by the power method on differences of forces.
double largest_eigenvalue(EquilibriumSystem& system, const Vector& at, const Vector& force) {
  constexpr int n_iterations = 40;
  constexpr double small = 1e-6; // mm
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  Vector mode(at.size());
  for (double& entry : mode) entry = normal(generator);
  double eigenvalue = 0;
  for (int n = 0; n < n_iterations; ++n) {
    // What the first image leaves out are the entries that are not free.
    const Vector image = (force - system.imbalance(at + (small / mode.norm()) * mode, 1)) / small;
    eigenvalue = image.norm();
    if (!(eigenvalue > 0)) return 1;
    mode = image;
  }
  return eigenvalue;
}

class ForceScaling : public Method {
 public:
  explicit ForceScaling(double eigenvalue) : alpha_(1 / eigenvalue) {}
  bool step(Vector& at, const Vector& force) override {
    at += alpha_ * force;
    return true;
  }

 private:
  double alpha_; ///< mm/N
};

class Fire : public Method {
 public:
  explicit Fire(double eigenvalue)
      : longest_(1 / std::sqrt(eigenvalue)), time_step_(0.1 * longest_) {} // all masses 1

  bool step(Vector& at, const Vector& force) override {
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
    return true;
  }

 private:
  static constexpr double first_mixing = 0.1;
  double longest_, time_step_, mixing_ = first_mixing;
  int n_downhill_ = 0;
  Vector velocity_;
};

class Lbfgs : public Method {
 public:
  Lbfgs(EquilibriumSystem& system, double eigenvalue) : system_(system), scale_(1 / eigenvalue) {}

  bool step(Vector& at, const Vector& force) override {
    if (last_at_.size() > 0) remember(at - last_at_, last_force_ - force);
    last_at_ = at;
    last_force_ = force;
    if (line_search(system_, at, direction(force), force, 1)) return true;
    pairs_.clear(); // what was learnt here misleads: once more along the force alone
    return line_search(system_, at, scale_ * force, force, 1);
  }

 private:
  static constexpr std::size_t n_pairs = 10;
  struct Pair {
    Vector move, change; ///< mm; of the potential's gradient, N
    double product;
  };
  EquilibriumSystem& system_;
  double scale_; ///< mm/N
  Vector last_at_, last_force_;
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

std::unique_ptr<Method> make_method(cases::Solver method, EquilibriumSystem& system, double eigenvalue) {
  switch (method) {
  case cases::Solver::force_scaling:
    return std::make_unique<ForceScaling>(eigenvalue);
  case cases::Solver::fire:
    return std::make_unique<Fire>(eigenvalue);
  default:
    return std::make_unique<Lbfgs>(system, eigenvalue);
  }
}

} // namespace

Equilibrium relax(EquilibriumSystem& system, const Vector& start, cases::Solver method,
                  const EquilibriumSettings& settings) {
  Equilibrium result;
  Vector at = start;
  system.move_supports(at, 1);
  Vector force = system.imbalance(at, 1);
  const auto iteration = make_method(method, system, largest_eigenvalue(system, at, force));
  const auto give_up = [&](const std::string& reason) {
    throw cases::SolveError("mass-spring equilibrium by " + cases::name_of(method) + ": " + reason, 0,
                            result.residual);
  };
  for (;; ++result.relaxation_iterations) {
    result.residual = relative_imbalance(system, force, at);
    if (!std::isfinite(result.residual)) give_up("it diverges");
    if (result.residual <= settings.tolerance) break;
    if (result.relaxation_iterations == settings.max_relaxation_iterations)
      give_up("the limit of " + std::to_string(settings.max_relaxation_iterations) +
              " iterations was reached");
    if (settings.should_stop && settings.should_stop()) give_up("it was stopped");
    if (!iteration->step(at, force)) give_up("no step lowers the potential");
    force = system.imbalance(at, 1);
  }
  result.load_reached = 1;
  result.is_stable = settings.stability == Stability::require && system.is_stable(at);
  if (settings.lowest_eigenvalue == LowestEigenvalue::report)
    result.lowest_eigenvalue = system.lowest_mode(at).eigenvalue;
  result.displacement = std::move(at);
  return result;
}

} // namespace springproof::msm
