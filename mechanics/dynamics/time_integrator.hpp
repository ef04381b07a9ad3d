#pragma once

#include "mechanics/dynamics/dynamic_problem.hpp"
#include "mechanics/dynamics/scheme.hpp"
#include "mechanics/equilibrium/newton.hpp"

namespace springproof::mechanics {

/// Vectors in the order of a problem.
struct Motion {
  double time = 0;                             ///< s
  Vector displacement, velocity, acceleration; ///< mm, mm/s, mm/s²
};

struct IntegrationSettings {
  EquilibriumSettings newton =
      nearly_linear();   ///< tolerance, iteration limits and should_stop hold for each step
  int max_halvings = 10; ///< limit per advance(); a step whose equation is not solved is halved
  int substeps = 1;      ///< that advance() makes of a step
  /// Limit on a step's linear iterations, in all; see in_real_time().
  std::optional<int> enough_linear_iterations = {};
  /// Directions may be found in single precision.
  bool in_single_precision = false;

  /// Settings for a step that changes little: its first direction leads all the way.
  static EquilibriumSettings nearly_linear() {
    EquilibriumSettings settings;
    settings.first_forcing = 1e-3;
    return settings;
  }
};

/// Settings that bound the time of a step. It ends with a residual of 1 % of the loads, or with what is left
/// after two iterations of Newton's method and the given number of the linear solver. A step left with more
/// than the loads is halved. Simulators take one linear solution a step (Baraff and Witkin 1998).
IntegrationSettings in_real_time(int linear_iterations);

/// Settings for steps that are solved to a few digits, 1e-4 of the loads or more.
IntegrationSettings to_few_digits(double tolerance);

/// A body in motion, from step to step. After its first step it allocates nothing; a problem may.
class TimeIntegrator {
 public:
  TimeIntegrator(const TimeIntegrator&) = delete; // Newton's method refers to settings and work
  TimeIntegrator& operator=(const TimeIntegrator&) = delete;
  /// @param problem   must outlive this
  /// @param start     displacement (mm) and velocity (mm/s) at a time; the acceleration follows from the
  ///                  forces
  /// @throws cases::SolveError when the start has no forces
  TimeIntegrator(DynamicProblem& problem, const cases::TimeScheme& scheme, Motion start,
                 const IntegrationSettings& settings = {});

  /// Steps to a time (s), in substeps; one whose equation is not solved is halved.
  /// @throws cases::SolveError with the time reached, where now() is left
  void advance(double to);

  const Motion& now() const { return now_; }
  const Equilibrium& work() const { return work_; } ///< Newton's iterations and the residual of the last step
  int n_halvings() const { return n_halvings_; }    ///< steps that were halved
  /// Steps in real time that were taken with more residual than the tolerance.
  int n_unfinished() const { return n_unfinished_; }
  double largest_residual() const { return largest_residual_; } ///< largest relative one left by a step

  /// Returns v . M v / 2, N mm, over the free degrees of freedom.
  double kinetic_energy();

 private:
  DynamicProblem& problem_;
  cases::TimeScheme scheme_;
  IntegrationSettings settings_;
  Equilibrium work_;
  Newton newton_;
  Motion now_, next_;
  std::optional<Motion> before_; ///< bdf2: the beginning of the last step
  int n_halvings_ = 0, n_unfinished_ = 0;
  double largest_residual_ = 0;
  double scale_ = 0;       ///< N: largest forces so far
  bool has_loads_ = false; ///< some load has acted so far
  std::string failure_;
  Vector force_, known_, product_, residual_, step_;
  bool is_smooth_ = false;  ///< the last step changed the acceleration by less than its size
  Vector guess_;            ///< place_ before supports are moved
  Vector place_, supports_; ///< w of the step; a displacement whose constrained entries are the step's

  void start();
  bool try_step(double to, double target);
  void add_known_forces(const StepCoefficients& coefficients);
  void combine(const KnownMotion& known);
  bool solve(const StepTerms& terms, const StepCoefficients& coefficients, double to);
  bool find_place();
  enum class Guess { acceleration_stays, velocity_stays, displacement_stays };
  void predict(const StepCoefficients& coefficients, double to, Guess guess);
  void take_along();
  void finish_step(const StepCoefficients& coefficients, double to);
  double norm(const Vector& of) const;
  [[noreturn]] void give_up(const std::string& reason);
};

} // namespace springproof::mechanics
