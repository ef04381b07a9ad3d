#include "mechanics/dynamics/slowest_vibration.hpp"

#include <cmath>
#include <random>
#include <vector>

namespace springproof::mechanics {

namespace {

constexpr std::size_t n_rigid_motions = 6;
constexpr int max_iterations = 60;
constexpr double settled = 5e-3; ///< relative change of omega² from one iteration to the next
constexpr double forcing = 1e-3; ///< linear solver's tolerance; omega² errs by as much, relative

class InverseIteration {
 public:
  InverseIteration(DynamicProblem& problem, const Vector& at, double shift)
      : problem_(problem), at_(at), shift_(shift), force_(Vector::Zero(at.size())) {
    problem_.set_step({shift_, 0, at_, force_, at_, 1});
    problem_.residual(at_, 0, Expect::residual, at_start_);
  }

  /// Returns omega² of the slowest motion not found before.
  std::optional<double> next() {
    start();
    double last = -1;
    for (int i = 0; i < max_iterations; ++i) {
      leave_out_found();
      problem_.mass_product(shape_, weighted_);
      const double size = std::sqrt(problem_.dot(shape_, weighted_));
      if (!(size > 0)) return std::nullopt;
      shape_ /= size;
      weighted_ /= size;
      if (!solve()) return std::nullopt;
      problem_.mass_product(solved_, product_);
      const double shifted = problem_.dot(solved_, weighted_) / problem_.dot(solved_, product_);
      if (!std::isfinite(shifted)) return std::nullopt;
      shape_ = solved_;
      if (std::abs(shifted - last) <= settled * shifted) return shifted - shift_;
      last = shifted;
    }
    return std::nullopt;
  }

  void found_rigid() {
    problem_.mass_product(shape_, product_);
    found_.push_back({shape_ / problem_.dot(shape_, product_), product_});
  }

  double damping_ratio(double omega) {
    problem_.damping_product(shape_, weighted_);
    problem_.mass_product(shape_, product_);
    return problem_.dot(shape_, weighted_) / (2 * omega * problem_.dot(shape_, product_));
  }

 private:
  struct Found {
    Vector shape, weighted; ///< x/(x.Mx) and M x
  };
  DynamicProblem& problem_;
  const Vector& at_;
  double shift_;
  std::vector<Found> found_;
  Vector force_, at_start_; ///< force of the step; residual at the start without it
  Vector shape_, weighted_, solved_, product_, residual_;

  /// Sets a shape with a part of every vibration, 0 on supports.
  void start() {
    std::mt19937 generator(1);
    shape_.setZero(at_.size());
    problem_.draw(generator, shape_, [](double& entry, auto number) {
      entry = static_cast<double>(number) / 4294967296.0 - 0.5;
    });
    problem_.mass_product(shape_, weighted_);
    if (!solve()) solved_.setZero(at_.size()); // zero: next() gives up
    shape_ = solved_;
  }
  /// Solves (K + shift M) solved_ = weighted_, as the step that such a force makes from the state.
  bool solve() {
    const double held = std::sqrt(problem_.dot(at_start_, at_start_)),
                 size = std::sqrt(problem_.dot(weighted_, weighted_));
    const double factor = held > 0 && size > 0 ? held / size : 1; // so that neither is rounding of the other
    force_ = factor * weighted_ - at_start_;
    problem_.set_step({shift_, 0, at_, force_, at_, factor * size});
    problem_.residual(at_, 0, Expect::direction, residual_);
    if (!problem_.direction(at_, residual_, 0, forcing, Convexity::exact, solved_)) return false;
    solved_ /= factor;
    return true;
  }
  void leave_out_found() {
    for (const auto& [shape, weighted] : found_) shape_ -= problem_.dot(weighted, shape_) * shape;
  }
};

} // namespace

std::optional<cases::Vibration> slowest_vibration(DynamicProblem& problem, const Vector& at, double seconds) {
  const double shift = 1 / (seconds * seconds);
  InverseIteration iteration(problem, at, shift);
  for (std::size_t n = 0; n <= n_rigid_motions; ++n) {
    const auto omega_squared = iteration.next();
    if (!omega_squared) return std::nullopt;
    if (*omega_squared > shift / 10) {
      const double omega = std::sqrt(*omega_squared);
      return cases::Vibration{omega, iteration.damping_ratio(omega)};
    }
    iteration.found_rigid();
  }
  return std::nullopt;
}

} // namespace springproof::mechanics
