#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/dynamic_problem.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/real_time/euler.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace springproof::mechanics {

/// Points with masses of their own, and the forces between them.
struct PointBody {
  std::vector<double> mass, mass_damping; ///< t and t/s, one per point
  ForcesAt forces;
  FreeTangent tangent; ///< what Newton's method and vibrations take
};

/// The motion of points under the loads and supports of a scene, whose steps a method makes. Vectors have
/// three entries per point.
class PointsInTime : public DynamicProblem {
 public:
  /// @param scene  the points are its mesh's nodes; must outlive this
  PointsInTime(const cases::Scene& scene, PointBody body, MakeStep make_step);

  /// Switches to Newton's method in place of the method of steps, or back.
  void solve_by_newton(bool does) { has_method_ = !does; }

  /// Holds a place of the body by a spring to a place outside of it, which methods solve with the body, until
  /// let_go(). Newton's method does not take it.
  PullOfPoints& hold(PullOfPoints pull) { return pull_.emplace(std::move(pull)); }
  void let_go() { pull_.reset(); }
  /// Remembers the size of the pull at the end of a step: residuals are relative to the largest one, too.
  void remember_pull(const Vector& at) {
    if (pull_) largest_pull_ = std::max(largest_pull_, size_of_pull(at));
  }
  /// The motion begins again: what has pulled, and what a method knows of earlier steps, are forgotten.
  void begin_anew() {
    largest_pull_ = 0;
    make_step_ = fresh_make_step_;
  }

  /// What is left of the loads at a time (s) in a state without motion, over these loads, or over reactions
  /// where there are none.
  double out_of_balance(const Vector& at, double time);
  /// The state in balance at a time (s) that Newton's method finds from another one, near it.
  /// @throws cases::SolveError when it finds none
  Vector balanced(Vector at, double time);

  void mass_product(const Vector& motion, Vector& product) override { product = mass_.cwiseProduct(motion); }
  void damping_product(const Vector& motion, Vector& product) override {
    product = damping_.cwiseProduct(motion);
  }
  void external_force(double time, Vector& force) override;
  void supports_at(double time, Vector& displacement) const override;
  void set_step(const StepTerms& terms) override;

  using NonlinearProblem::direction;
  using NonlinearProblem::residual;
  void residual(const Vector& at, double load_factor, Expect expect, Vector& residual) override;
  Size size(const Vector& residual, const Vector& at) override;
  bool direction(const Vector& at, const Vector& residual, double load_factor, double forcing,
                 Convexity convexity, Vector& step) override;
  /// @throws cases::SolveError where the method has left finite places
  std::optional<Solved> solve_at(Vector& at, double load_factor) override;
  Merit merit() const override { return Merit::work; }
  std::optional<bool> is_stable(const Vector& /*at*/) override { return std::nullopt; }
  int n_inverted(const Vector& at) override;
  std::size_t n_unknowns() const override { return cases::index(body_.tangent.n_free); }
  Work work() const override { return work_; }

 private:
  const cases::Scene& scene_;
  PointBody body_;
  MakeStep make_step_, fresh_make_step_;
  bool has_method_ = true;
  Vector free_, mass_, damping_; ///< 1, t and t/s on free degrees of freedom, 0 on others
  std::vector<LoadInTime> loads_;
  double scale_ = 0;        ///< N: of the step
  bool is_substep_ = false; ///< whose residual nobody asks for
  Vector diagonal_;         ///< N/mm
  StepEquation step_;
  Work work_;
  std::optional<PullOfPoints> pull_{};
  double largest_pull_ = 0; ///< N

  void rest_at(double time, const Vector& at, Vector& force);
  double size_of_pull(const Vector& at) const; ///< N
};

/// One vector per point of a vector of PointsInTime, and the other way round.
Points to_points(const Vector& vector);
Vector to_vector(const Points& points);

} // namespace springproof::mechanics
