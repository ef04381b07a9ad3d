#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace springproof::mechanics {

using Vector = Eigen::VectorXd;

/// Which symmetric matrix Newton's direction comes from.
enum class Convexity {
  exact,   ///< the tangent itself
  clamped, ///< without the springs' negative transverse terms: positive semidefinite, keeps every symmetry
  shifted  ///< the tangent plus twice its lowest eigenvalue on the diagonal: long steps along that mode
};

/// What a line search goes by.
enum class Merit {
  energy, ///< it has to fall (Armijo)
  work,   ///< the residual's work on the step: its size has to fall, or its sign to stay
  none    ///< any state with a finite residual: saddle points, linear problems
};

/// What will probably be asked of a state after its residual: a problem that assembles both together saves
/// an assembly.
enum class Expect { residual, direction };

enum class RestState { sound, mechanism, unstable, unknown };

/// Nonlinear equations r(u, load factor) = 0 of a supported and loaded body. Any path parameter may be the
/// load factor; any terms (inertia too) may be in r, as long as direction() knows their tangent. Vectors are
/// in whatever order the problem keeps them; with several ranks each has its own part. Constrained entries
/// are 0 in residuals and directions; in states they are where the supports are.
class NonlinearProblem {
 public:
  virtual ~NonlinearProblem() = default;

  /// Minus the gradient of the energy, where there is one: N.
  /// @param residual  resized to match `at`; must not alias it. Not finite where `at` is not admissible (a
  /// cell turned inside out)
  virtual void residual(const Vector& at, double load_factor, Expect expect, Vector& residual) = 0;
  Vector residual(const Vector& at, double load_factor, Expect expect = Expect::residual) {
    Vector found;
    residual(at, load_factor, expect, found);
    return found;
  }

  struct Size {
    double relative;              ///< |residual| over the norm of what acts on the body: loads or reactions
    bool constraints_hold = true; ///< whatever else has to hold of an equilibrium
  };
  /// @param residual  the last that was evaluated, at this state
  virtual Size size(const Vector& residual, const Vector& at) = 0;

  /// Newton's direction: solves tangent * step = residual.
  /// @param residual  the last that was evaluated, at this state
  /// @param forcing   allowed |residual - tangent step| / |residual|; a direct solver does better
  /// @param step      must not alias the others; meaningless where there is no direction
  /// @return whether there is one: not when the solver fails, or an energy would not fall along the step
  virtual bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                         Convexity convexity, Vector& step) = 0;
  std::optional<Vector> direction(const Vector& at, const Vector& residual, double load_factor,
                                  double forcing, Convexity convexity) {
    Vector step;
    if (!direction(at, residual, load_factor, forcing, convexity, step)) return std::nullopt;
    return step;
  }

  /// What the next line search goes by.
  virtual Merit merit() const = 0;
  /// Energy less the work of the dead loads, N mm; asked of problems whose merit it is.
  virtual double energy(const Vector& /*at*/, double /*load_factor*/) { return 0; }

  struct Solved {
    bool converged;
    int newton_iterations;
    double residual; ///< relative
  };
  /// A problem's own solver in place of Newton's method here.
  /// @param at  where to start; on success the solution, otherwise where it has come
  virtual std::optional<Solved> solve_at(Vector& /*at*/, double /*load_factor*/) { return std::nullopt; }

  /// Whether the exact tangent is positive definite; nothing when that is not known.
  virtual std::optional<bool> is_stable(const Vector& at) = 0;
  /// What the tangent at rest says of the body; mechanism: some motion meets (almost) no stiffness; unknown:
  /// its linear solver fails.
  virtual RestState rest_state() { return RestState::sound; }
  /// Cause of RestState::unstable, a text to follow "unstable at rest".
  virtual std::string cause_of_instability() const { return ""; }
  struct Mode {
    double eigenvalue; ///< N/mm
    Vector shape;      ///< length 1
  };
  /// The lowest eigenvalue of the exact tangent on the free degrees of freedom, and its eigenvector, to about
  /// three digits.
  virtual std::optional<Mode> lowest_mode(const Vector& /*at*/) { return std::nullopt; }
  /// Cells with a corner Jacobian <= 0.
  virtual int n_inverted(const Vector& /*at*/) { return 0; }

  /// Whether the path has to move supports with the load factor; not where residual and direction do.
  virtual bool moves_supports() const { return false; }
  virtual void move_supports(Vector& /*at*/, double /*load_factor*/) const {}

  /// Products, maxima and conditions over all ranks.
  virtual double dot(const Vector& left, const Vector& right) const { return left.dot(right); }
  virtual double largest(const Vector& of) const { return of.cwiseAbs().maxCoeff(); } ///< magnitude
  virtual bool any_rank(bool here) const { return here; }

  /// A run of entries of this rank's vectors. `skipped` counts the other ranks' entries between it and the
  /// run before.
  struct Run {
    Eigen::Index first, n, skipped;
  };
  /// The runs of this rank, in order; none where a vector is whole here.
  virtual std::vector<Run> runs() const { return {}; }
  /// Calls action(entry, number) with a generator's numbers for the entries of a vector: where runs() tells,
  /// the same numbers on any number of ranks.
  template<class Generator, class Action>
  void draw(Generator& generator, Vector& vector, const Action& action) const {
    const std::vector<Run> parts = runs(); // none allocates nothing: steps in real time draw too
    if (parts.empty())
      for (double& entry : vector) action(entry, generator());
    for (const Run& run : parts) {
      for (Eigen::Index i = 0; i < run.skipped; ++i) generator();
      for (double& entry : vector.segment(run.first, run.n)) action(entry, generator());
    }
  }

  struct Work {
    long linear_iterations = 0; ///< iterations of the linear solver
    long factorisations = 0;    ///< factorisations of the tangent
    long force_evaluations = 0; ///< with or without their tangent
    Work operator-(const Work& before) const {
      return {linear_iterations - before.linear_iterations, factorisations - before.factorisations,
              force_evaluations - before.force_evaluations};
    }
  };
  /// Counts since the problem was made; 0 where a kind of problem does not count.
  virtual Work work() const { return {}; }
  virtual std::size_t n_unknowns() const { return 0; } ///< free degrees of freedom, over all ranks
};

} // namespace springproof::mechanics
