#pragma once

#include "mechanics/dynamics/dynamic_problem.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

/// Which steps of a motion a preconditioner serves, and when it is made anew.
namespace springproof::msm::grid {

/// Factors of mass and damping in a step's equation. A preconditioner does not mind their rounding.
struct Factors {
  double mass = 0, damping = 0;
  bool are_of(const mechanics::StepTerms& terms) const {
    const auto is_near = [](double a, double b) { return std::abs(a - b) <= 1e-3 * std::abs(b); };
    return is_near(mass, terms.mass) && is_near(damping, terms.damping);
  }
};

/// Which steps the factor serves. Steps that are halved leave it alone; it is made anew when the first step
/// was of another scheme, as with bdf2, and when a motion goes on in steps of another length.
class FactorSchedule {
 public:
  void begin_step(const mechanics::StepTerms& terms) {
    n_alike_ = step_.are_of(terms) ? n_alike_ + 1 : 1;
    step_ = {terms.mass, terms.damping};
    serves_ = made_with_ && made_with_->are_of(terms);
    if (serves_) ++n_served_;
    n_to_pass_ = std::max(0, n_to_pass_ - 1);
  }
  const Factors& step() const { return step_; }
  bool is_due() const {
    const int enough_alike = !made_with_ ? 1 : n_served_ <= 2 ? 2 : 50;
    return !serves_ && n_alike_ == enough_alike;
  }
  void make() {
    made_with_ = step_;
    serves_ = true;
    n_served_ = n_to_pass_ = 0;
  }
  /// Far from where the factor was made, cycles that are prepared there do better.
  void pass() { n_to_pass_ = 16; }
  bool serves() const { return serves_ && n_to_pass_ == 0; }

 private:
  Factors step_;
  std::optional<Factors> made_with_; ///< none: it was not
  bool serves_ = false;              ///< made with the factors of this step
  int n_alike_ = 0;                  ///< steps on end with these
  int n_served_ = 0;                 ///< steps of its length since it was made
  int n_to_pass_ = 0;                ///< steps before it is tried again
};

/// Whether the cycle has become slow since it was prepared, by its iterations.
class CycleSpeed {
 public:
  bool is_slow() const { return is_slow_; }
  void forget() { is_slow_ = true; }
  /// @param is_prepared  whether it was prepared for this solution
  void measure(int iterations, double forcing, bool is_prepared) {
    const double slowness = iterations / -std::log(forcing);
    if (is_prepared) usual_ = slowness;
    is_slow_ = slowness > 2 * usual_ + 1;
  }

 private:
  double usual_ = 0; ///< iterations over what was asked for, where the cycle was prepared
  bool is_slow_ = true;
};

} // namespace springproof::msm::grid
