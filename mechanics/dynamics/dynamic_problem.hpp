#pragma once

#include "cases/case/dynamics.hpp"
#include "cases/case/solution.hpp"
#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <limits>
#include <utility>
#include <vector>

namespace springproof::mechanics {

class Contact;

/// A load of a motion: forces on some entries of a vector, and how much of them acts when. A replay has
/// hundreds, each of a few nodes.
class LoadInTime {
 public:
  /// @param force  N, at a factor of 1; 0 on constrained degrees of freedom
  LoadInTime(cases::History history, const Eigen::VectorXd& force) : history_(std::move(history)) {
    for (Eigen::Index i = 0; i < force.size(); ++i)
      if (force[i] != 0) force_.emplace_back(i, force[i]);
  }
  /// force += the load at a time (s), N
  void add(double time, Eigen::VectorXd& force) const {
    const double factor = history_.at(time);
    if (factor == 0) return;
    for (const auto& [entry, at_full] : force_) force[entry] += factor * at_full;
  }

 private:
  cases::History history_;
  std::vector<std::pair<Eigen::Index, double>> force_;
};

/// A step in time as its problem sees it: the equation that step_coefficients() is about.
struct StepTerms {
  double mass = 0, damping = 0; ///< factors of M (1/s²) and C (1/s)
  const Vector& origin;         ///< mm: displacement when the step begins
  const Vector& force;          ///< N, on free degrees of freedom: loads, and M and C times what is known
  const Vector& supports; ///< mm: constrained entries are where the step holds them; others mean nothing
  double scale = 0;       ///< N: forces of the motion, which residuals are relative to
  /// Limit on the linear solver's iterations, over the whole step; none: as many as it takes.
  std::optional<int> enough_linear_iterations = {};
  bool in_single_precision = false; ///< directions may be found so
  /// Whether it is one of several substeps, and not the last one: its residual is not reported.
  bool is_substep = false;
  /// Time (s) from the step's beginning to its equation, in which a memory fades. Infinite: all has faded.
  double duration = std::numeric_limits<double>::infinity();
  double time = 0; ///< s: the equation's, at which tools are where their histories say
};

/// Nonlinear equations of a body that has mass. Masses are in tonnes (N s²/mm). In a step in time
///   r(u) = force - f_int(u) - (mass M + damping C) (u - origin)
/// on free degrees of freedom, at load factor 0; the tangent has mass M + damping C, and the energy half of
/// that matrix's quadratic form of u - origin, less force . u.
class DynamicProblem : public NonlinearProblem {
 public:
  /// M * motion and C * motion on free degrees of freedom, 0 on constrained ones; neither depends on the
  /// displacement. Entries of `motion` on supports count: where they move, a consistent mass couples them.
  /// @param product  resized to match `motion`; must not alias it
  virtual void mass_product(const Vector& motion, Vector& product) = 0;
  virtual void damping_product(const Vector& motion, Vector& product) = 0;

  /// All loads at a time (s), N; 0 on constrained degrees of freedom.
  virtual void external_force(double time, Vector& force) = 0;
  /// Writes where supports are at a time to the constrained entries of a displacement, mm.
  virtual void supports_at(double /*time*/, Vector& /*displacement*/) const {}

  /// The contact with tools; null: there are none.
  virtual Contact* contact() { return nullptr; }
  /// Norm of what tools do to nodes at the end of the step where it was largest so far, N. Residuals are
  /// relative to it too.
  virtual double largest_press() const { return 0; }
  /// What the tools do to the body in a state at a time (s), without the forces on single nodes.
  virtual std::vector<cases::ToolContact> tools_at(double /*time*/, const Vector& /*displacement*/) const {
    return {};
  }

  /// Fills in those entries of a velocity or acceleration that follow from this rank's degrees of freedom:
  /// entries of other ranks, unknowns that were condensed.
  virtual void complete(Vector& /*motion*/) {}

  /// Sets the step of all later evaluations. What the terms refer to must live until the next call.
  virtual void set_step(const StepTerms& terms) = 0;

  /// Makes a material's memory that of a body that has always been at this displacement. Friction takes the
  /// body to be at rest.
  virtual void begin_motion(const Vector& /*displacement*/) {}
  /// Takes what tools press in one state along with them, in a guess of the state at the step's time.
  virtual void follow_tools(double /*from_time*/, const Vector& /*from*/, Vector& /*guess*/) const {}
  /// Brings what a step's equation holds, the bounds of friction, to its solution.
  /// @return whether they agreed; otherwise the equation is another one now
  virtual bool settle(const Vector& /*solution*/) { return true; }
  /// Whether a step may go from one displacement to another; one whose way is not open is halved.
  virtual bool is_way_open(double /*from_time*/, const Vector& /*from*/, const Vector& /*to*/) const {
    return true;
  }
  /// Takes a step into that memory.
  /// @param displacement  mm, at the step's end    @param length  s
  virtual void end_step(const Vector& /*displacement*/, double /*length*/) {}

 protected:
  /// Returns a norm over its scale, 0 for a norm of 0; for size().
  static double relative(double norm, double scale) { return norm == 0 ? 0 : norm / scale; }
};

} // namespace springproof::mechanics
