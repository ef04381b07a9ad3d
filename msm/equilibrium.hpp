#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace springproof::msm {

using Vector = Eigen::VectorXd;

/// Which symmetric matrix Newton's direction comes from.
enum class Convexity {
  exact,   ///< the tangent itself
  clamped, ///< without the springs' negative transverse terms: positive semidefinite, keeps every symmetry
  shifted  ///< the tangent plus twice its lowest eigenvalue on the diagonal: long steps along that mode
};

/// A held and loaded lattice as Newton's method sees it. Vectors are displacements (mm) or forces (N) in
/// whatever order the lattice keeps them; entries that are not free degrees of freedom are 0, but in
/// displacements of a lattice whose supports move: there they are where the supports are.
class EquilibriumSystem {
 public:
  virtual ~EquilibriumSystem() = default;

  /// Applied forces at full load, N.
  virtual const Vector& load() const = 0;

  /// Internal plus load_factor times applied forces on the free degrees of freedom, N.
  virtual Vector imbalance(const Vector& displacement, double load_factor) = 0;

  /// Spring energy less the load's work from rest, N mm: what an equilibrium under dead load makes
  /// stationary.
  virtual double potential(const Vector& displacement, double load_factor) = 0;

  /// Newton's direction: solves tangent * step = imbalance.
  /// @param forcing  allowed |imbalance - tangent step| / |imbalance|; a direct solver does better
  /// @return nothing when the tangent is not positive definite, or the step is no descent
  virtual std::optional<Vector> direction(const Vector& displacement, const Vector& imbalance, double forcing,
                                          Convexity convexity) = 0;

  /// Whether the exact tangent is positive definite here.
  virtual bool is_stable(const Vector& displacement) = 0;

  struct Mode {
    double eigenvalue; ///< N/mm
    Vector shape;      ///< of length 1
  };
  /// The lowest eigenvalue of the exact tangent on the free degrees of freedom, and its eigenvector, to about
  /// three digits.
  virtual Mode lowest_mode(const Vector& displacement) = 0;

  /// Whether some motion meets (almost) no stiffness: the lowest pivot of the tangent at rest is lost in
  /// rounding.
  virtual bool is_mechanism() = 0;

  /// Cells with a corner Jacobian <= 0.
  virtual int n_inverted(const Vector& displacement) = 0;

  /// Whether supports are moved as the load factor grows.
  virtual bool moves_supports() const { return false; }
  /// Puts the supports where a load factor asks them to be.
  virtual void move_supports(Vector& /*displacement*/, double /*load_factor*/) const {}
  /// Norm of the forces that springs exert on supports, N: what a body that is only moved is measured
  /// against.
  virtual double reaction(const Vector& displacement) = 0;

  /// What the system was asked to do.
  struct Work {
    long linear_iterations = 0; ///< of the iterative linear solver
    long factorisations = 0;    ///< of the tangent
    long force_evaluations = 0; ///< calls of imbalance()
  };
  /// Since the system was made; what a kind of system does not count is 0.
  virtual Work work() const { return {}; }
};

enum class LowestEigenvalue { skip, report };
enum class Stability { require, ignore };

struct EquilibriumSettings {
  double tolerance = 1e-9;           ///< on |imbalance on free degrees of freedom| / |applied load|
  int max_newton_per_step = 40;      ///< more than twice what any load step that succeeded was seen to need
  int max_convexified_per_step = 12; ///< of these; what is not settled by then has lost its way
  int max_load_steps = 400;
  int max_newton_iterations = 4000;         ///< in all
  long max_relaxation_iterations = 1000000; ///< of an explicit relaxation
  std::function<bool()> should_stop = {};   ///< asked before every iteration; empty: never
  double first_load_step = 1;               ///< of the full load
  double largest_load_step = 1;             ///< of the full load
  double smallest_load_step = 1e-4;         ///< of the full load; a step below it means a limit point
  LowestEigenvalue lowest_eigenvalue = LowestEigenvalue::skip;
  Stability stability = Stability::require; ///< ignore: for a guess, or where it is known
  std::optional<Vector> guess;              ///< displacement at full load to try first
};

struct Equilibrium {
  Vector displacement; ///< mm
  double residual = 0;
  double load_reached = 0;
  int load_steps = 0; ///< those that succeeded
  int newton_iterations = 0;
  long relaxation_iterations = 0;
  int convexified_steps = 0; ///< Newton steps for which the exact tangent would not do
  int escapes = 0;           ///< from unstable equilibria met on the way
  bool is_stable = false;
  std::optional<double> lowest_eigenvalue; ///< N/mm
};

/// Static equilibrium at full load: Newton's method with an energy line search and load steps that adapt. The
/// tangent is clamped only where the exact one is not positive definite. An unstable equilibrium met on the
/// way (a bifurcation) is left along its lowest mode. The path has to stay connected: a step that left the
/// exact tangent and turned cells inside out is halved rather than taken.
/// @param start  displacement to start from, at load 0
/// @throws cases::SolveError with the load reached and the outcome (limit point, mechanism, ...)
Equilibrium find_equilibrium(EquilibriumSystem& system, const Vector& start,
                             const EquilibriumSettings& settings = {});

} // namespace springproof::msm
