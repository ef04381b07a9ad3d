#pragma once

#include "cases/case/solution.hpp"
#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <functional>

namespace springproof::mechanics {

enum class LowestEigenvalue { skip, report };
enum class Stability {
  require, ///< every equilibrium on the path must be stable
  report,  ///< tell for the last one
  ignore   ///< do not ask: a guess, or a known answer
};

/// What a path is asked for, and its limits. A path goes from a state of equilibrium at one load factor to
/// another; load steps are fractions of that way.
struct EquilibriumSettings {
  double tolerance = 1e-9; ///< limit for |residual on free degrees of freedom| / |applied load|
  double from = 0, to = 1; ///< load factors
  double first_load_step = 1;
  double largest_load_step = 1;
  double smallest_load_step = 1e-4;
  double first_forcing = 0.1;        ///< forcing of the first Newton iteration at a load
  int max_newton_per_step = 40;      ///< more than twice what any load step that succeeded was seen to need
  int easy_newton_per_step = 8;      ///< a load step that took no more is followed by one of twice the length
  int max_convexified_per_step = 12; ///< limit; what has not converged by then will not
  /// Iterations after which a state is taken as it is; none: only where the tolerance is met.
  std::optional<int> enough_newton_per_step = {};
  /// Whether a full step that halves the residual at least is seen as a gain without its energy.
  bool takes_full_steps = false;
  /// Whether Newton's method may use up its iterations where half of them have not gained a factor of ten.
  bool may_wander = false;
  int max_load_steps = 400;
  int max_newton_iterations = 4000;         ///< limit over the whole path
  long max_relaxation_iterations = 1000000; ///< limit for an explicit relaxation
  std::function<bool()> should_stop = {};   ///< asked before every iteration; empty: never
  LowestEigenvalue lowest_eigenvalue = LowestEigenvalue::skip;
  Stability stability = Stability::require;
  std::optional<Vector> guess = {}; ///< state at full load to try first
  /// Asked before a load step is taken, with the states and load factors at its ends. A step whose way is not
  /// open is halved. Empty: every way is.
  std::function<bool(const Vector& from, double load_from, const Vector& to, double load_to)> is_way_open =
      {};
};

struct Equilibrium {
  Vector state;
  double residual = 0;     ///< relative
  double load_reached = 0; ///< load factor
  int load_steps = 0;      ///< those that succeeded
  int newton_iterations = 0;
  long relaxation_iterations = 0;
  int convexified_steps = 0;               ///< Newton steps for which the exact tangent would not do
  int escapes = 0;                         ///< unstable equilibria met and left on the way
  std::optional<bool> is_stable;           ///< when required or reported, and known
  std::optional<double> lowest_eigenvalue; ///< N/mm
  NonlinearProblem::Work work;             ///< work done to find it
  std::size_t n_unknowns = 0;
};

/// Static equilibrium at the end of a path of equilibria: Newton's method with load steps that adapt, each
/// starting from the last increment extrapolated. The tangent is clamped only where the exact one is not
/// positive definite. An unstable equilibrium met on the way (a bifurcation) is left along its lowest mode,
/// where stability is required. The path has to stay connected: a step that left the exact tangent and turned
/// cells inside out is halved rather than taken.
/// @param start  state in equilibrium at settings.from; at load factor 0 any state but rest is a guess
/// @param name   the method's name, for messages
/// @throws cases::SolveError with the load reached, the outcome (limit point, mechanism, ...) and the work
/// done
Equilibrium find_equilibrium(NonlinearProblem& problem, const Vector& start, const std::string& name,
                             const EquilibriumSettings& settings = {});

/// The equilibrium at settings.to of a problem without unknowns: every degree of freedom is held or moved.
Equilibrium prescribed_state(const NonlinearProblem& problem, const Vector& start,
                             const EquilibriumSettings& settings);

/// Returns a converged solution, without displacements and what follows from them.
cases::Solution to_solution(const Equilibrium& equilibrium);

/// Settings with load steps in which no support turns by more than cases::largest_turn_of_step. Limits of the
/// path grow with `at_least`.
/// @param degrees   largest turn of a support at load factor 1
/// @param settings  their load factors from and to must be set
/// @param at_least  least number of load steps from load factor 0 to 1
EquilibriumSettings in_small_turns(double degrees, int at_least, EquilibriumSettings settings);

} // namespace springproof::mechanics
