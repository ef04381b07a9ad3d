#pragma once

#include "fem_reference/equations.hpp"
#include "fem_reference/inertia.hpp"
#include "mechanics/dynamics/dynamic_problem.hpp"
#include "mechanics/dynamics/load_in_time.hpp"

namespace springproof::fem_reference {

/// The motion of a scene's finite elements, on the states and with the forces of its static equations.
/// Pressures have no inertia.
class MovingEquations : public mechanics::DynamicProblem {
 public:
  /// @param scene      that the discretisation is of: already refined
  /// @param equations  of the discretisation; as it, must outlive this
  MovingEquations(const cases::Scene& scene, const Discretisation& discretisation,
                  const std::vector<Formulation>& formulations, EquilibriumEquations& equations);

  void mass_product(const State& motion, State& product) override {
    multiply(inertia_.mass, motion, product);
  }
  void damping_product(const State& motion, State& product) override {
    multiply(inertia_.damping, motion, product);
  }
  void external_force(double time, State& force) override;
  void supports_at(double time, State& displacement) const override;
  void complete(State& motion) override { equations_.complete(motion); }
  void set_step(const mechanics::StepTerms& terms) override;

  using NonlinearProblem::direction;
  using NonlinearProblem::residual;
  void residual(const State& at, double load_factor, mechanics::Expect expect, State& residual) override {
    equations_.residual(at, load_factor, expect, residual);
  }
  Size size(const State& residual, const State& at) override { return equations_.size(residual, at); }
  bool direction(const State& at, const State& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, State& step) override {
    return equations_.direction(at, residual, load_factor, forcing, convexity, step);
  }
  mechanics::Merit merit() const override { return equations_.merit(); }
  std::optional<bool> is_stable(const State& /*at*/) override { return std::nullopt; }
  double dot(const State& left, const State& right) const override { return equations_.dot(left, right); }
  double largest(const State& of) const override { return equations_.largest(of); }
  bool any_rank(bool here) const override { return equations_.any_rank(here); }
  Work work() const override { return equations_.work(); }
  std::size_t n_unknowns() const override { return equations_.n_unknowns(); }

 private:
  const Discretisation& discretisation_;
  EquilibriumEquations& equations_;
  Inertia inertia_;
  std::vector<mechanics::LoadInTime> loads_;
  Vector motion_, product_; ///< with ghosts
  LocalMatrix added_;       ///< mass M + damping C of the step
  double mass_ = 0, damping_ = 0;

  void multiply(const LocalMatrix& matrix, const State& motion, State& product);
};

} // namespace springproof::fem_reference
