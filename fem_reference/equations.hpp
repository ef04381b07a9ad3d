#pragma once

#include "fem_reference/assembly.hpp"
#include "fem_reference/element_equations.hpp"
#include "fem_reference/inertia.hpp"
#include "fem_reference/linear_solver.hpp"
#include "mechanics/petsc/distributed_problem.hpp"

namespace springproof::fem_reference {

constexpr double volume_tolerance = 1e-12; ///< relative volume of a cell's condensed pressure

/// The discrete equations of a scene: internal force = load factor * load, or those of its motion. Supports
/// are part of the equations: a step takes constrained degrees of freedom to where they have to be. Pressures
/// have no inertia.
class EquilibriumEquations : public mechanics::petsc::DistributedProblem<ElementEquations> {
 public:
  /// @param formulations  one for each of the discretisation's materials, which alone differ
  EquilibriumEquations(const Discretisation& discretisation, const std::vector<Formulation>& formulations);

  State rest() const override {
    return State::Zero(static_cast<Eigen::Index>(n_dofs() + assembly_.n_pressures()));
  }

  void residual(const State& at, double load_factor, mechanics::Expect expect, State& residual) override;
  /// Constraints hold where volumes agree with pressures and supports are where they have to be.
  Size size(const State& /*residual*/, const State& /*at*/) override { return size_; }
  bool direction(const State& at, const State& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, State& step) override;
  /// Work says nothing about a saddle point (pressure modes), while supports still move, or when one step is
  /// exact.
  mechanics::Merit merit() const override;
  /// Stability by the tangent last solved with.
  std::optional<bool> is_stable(const State& at) override;
  Work work() const override { return {solver_.n_iterations(), solver_.n_factorisations(), n_evaluations_}; }

  std::size_t n_unknowns() const override {
    return static_cast<std::size_t>(discretisation_.constraints.n_unknowns);
  }

  std::optional<int> negative_eigenvalues() const override { return negative_eigenvalues_; }

  /// Gives the body a scene's masses, damping and loads in time, which the functions below use.
  /// @param scene         the discretisation's, already refined
  /// @param formulations  as in the constructor
  void set_in_motion(const cases::Scene& scene, const std::vector<Formulation>& formulations);
  void mass_product(const State& motion, State& product) override {
    multiply(motion_->inertia.mass, motion, product);
  }
  void damping_product(const State& motion, State& product) override {
    multiply(motion_->inertia.damping, motion, product);
  }
  void external_force(double time, State& force) override;
  void supports_at(double time, State& displacement) const override;
  /// Completes a velocity whose own degrees of freedom are given: sets those of other ranks and, in a linear
  /// body, the pressures that belong to them.
  void complete(State& motion) override;
  /// Makes residuals those of the step, relative to its scale, whatever the load factor.
  void set_step(const mechanics::StepTerms& terms) override;

  /// Deformed volume of this rank's cells, mm³, with the element's own displacement.
  std::vector<double> cell_volumes(const State& state) { return assembly_.cell_volumes(state); }
  void add_norms(const State& state, DisplacementNorms& norms) { assembly_.add_norms(state, norms); }
  /// See Assembly.
  void add_fields(const State& state, int n_refinements, ElementFields& fields) {
    assembly_.add_fields(state, n_refinements, fields);
  }

 private:
  std::size_t n_dofs() const { return discretisation_.constraints.is_constrained.size(); }
  bool is_linear() const { return formulation_.kinematics == Kinematics::linear; }
  void evaluate(const State& state, double load_factor, Wanted wanted);
  void evaluate_for_direction(const State& state, double load_factor);
  double load(std::size_t dof, double load_factor) const;
  void add_inertia(const State& state, Wanted wanted);
  void multiply(const LocalMatrix& matrix, const State& motion, State& product);
  void add_to_tangent(const LocalMatrix& added);
  void measure(std::optional<double> volume_mismatch, double load_factor);

  const Discretisation& discretisation_;
  Formulation formulation_; ///< the first material's
  Assembly assembly_;
  LinearSolver solver_;
  Vector force_;           ///< imbalance of the last evaluation, zero on constrained degrees of freedom, N
  Vector right_hand_side_; ///< the Newton system's
  Vector correction_;      ///< its solution
  Vector inertia_force_;   ///< what a step in time adds
  struct Motion {
    Inertia inertia;
    std::vector<mechanics::LoadInTime> loads;
    LocalMatrix added; ///< mass M + damping C of the step, N/mm; its pattern is part of the tangent's
    Vector moved;      ///< with ghosts
  };
  std::optional<Motion> motion_; ///< present for a body in motion
  std::optional<mechanics::StepTerms> step_;
  double load_norm_ = 0;
  long n_evaluations_ = 0, n_tangents_ = 0;
  bool has_tangent_ = false; ///< it was assembled at a valid state
  // results for the state last evaluated
  bool has_right_hand_side_ = false;
  Size size_ = {};                     ///< not finite: inverted at a quadrature point, or not a number
  std::vector<double> prescribed_gap_; ///< mm per local degree of freedom
  double largest_gap_ = 0;             ///< mm
  std::optional<int> negative_eigenvalues_;
};

} // namespace springproof::fem_reference
