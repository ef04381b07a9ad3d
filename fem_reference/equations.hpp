#pragma once

#include "fem_reference/discretisation.hpp"
#include "fem_reference/element_equations.hpp"
#include "fem_reference/inertia.hpp"
#include "fem_reference/laws/formulation.hpp"
#include "fem_reference/linear_solver.hpp"
#include "mechanics/dynamics/fading_memory.hpp"
#include "mechanics/petsc/distributed_problem.hpp"

namespace springproof::fem_reference {

/// Displacement of every local degree of freedom (ghosts current, mm), then the internal unknowns of this
/// rank's cells: pressures (MPa) or components of bubbles (mm), n_internal() per cell.
using State = mechanics::Vector;

/// What a rank's cells lack in balance of their internal unknowns.
struct InternalImbalance {
  double volume_mismatch = 0; ///< the largest
  double of_bubbles = 0;      ///< sum of squares, N²
};

/// The loop over cells: internal forces, the assembled tangent, and what the condensed unknowns need.
class Assembly {
 public:
  /// @param formulations  one for each of the discretisation's materials
  Assembly(const Discretisation& discretisation, const std::vector<Formulation>& formulations);

  /// @param gap        mm to the prescribed displacements, per local degree of freedom; 0 where unconstrained
  /// @param force      becomes the internal force, N, with what volumes lack at pressures of nodes, mm³
  /// @param condensed  when a tangent is wanted, becomes the internal force with the imbalance of internal
  ///                   unknowns and what the gap will add to it, N
  /// @return nothing when one of this rank's cells is inverted at a quadrature point, or not a number: sums
  ///         are then incomplete
  std::optional<InternalImbalance> assemble(const State& state, const std::vector<double>& gap, Wanted wanted,
                                            Vec force, Vec condensed);

  /// Sets the internal unknowns that belong to a correction's displacement.
  void complete_correction(State& correction) const;
  /// Sets the cells' pressures to those of their nodes.  @param unknowns  those of this rank, with ghosts
  void set_pressures(const ReadEntries& unknowns, State& correction) const;
  /// Takes the internal unknowns of the current state as balanced, for a linear body's next correction.
  void internals_are_balanced();
  /// Calls action(cell, its geometry, displacement, internal unknowns) for this rank's cells.
  template<class Action>
  void for_each_cell(const State& state, const Action& action) {
    for (int cell = 0; cell < discretisation_.nodes.n_cells; ++cell)
      action(cell, discretisation_.geometry.of(cell), displacement(cell, state), internal(cell, state));
  }

  /// Gives the cells the memory of a scene's materials, which begin_motion(), set_step() and end_step() of
  /// mechanics::DynamicProblem change.
  void set_memory(const cases::Case& definition);
  mechanics::FadingMemory* memory() { return memory_ ? &*memory_ : nullptr; }
  /// Elastic stresses that the memory is computed from.
  mechanics::Vector elastic_stresses(const State& state);

  std::size_t n_internal() const { return n_internal_; }
  Mat tangent() const { return tangent_.get(); }

 private:
  CellKernel& kernel(int cell) const;
  std::size_t material_of(int cell) const;
  int n_of_memory() const { return CellMemory::n * discretisation_.element.n_points(); }
  CellMemory memory_of(int cell) const;
  const double* internal(int cell, const State& state) const;
  /// Displacement of a cell's nodes, mm, kept until the next call.
  const double* displacement(int cell, const State& state);
  void add_tangent(int cell, const CellResult& result, const std::vector<double>& gap,
                   const WriteEntries& condensed);
  /// Unknown k of a cell, in the order of its forces.
  std::size_t unknown(int cell, std::size_t k) const;
  std::size_t n_displacements() const { return discretisation_.constraints.is_constrained.size(); }

  const Discretisation& discretisation_;
  std::vector<std::unique_ptr<CellKernel>> kernels_; ///< one for each material
  std::optional<mechanics::FadingMemory> memory_;    ///< at [n_of_memory()*cell + 7*q + c], see CellMemory
  Matrix tangent_;
  std::vector<double> internal_residual_, internal_slope_; ///< every cell's, as in CellResult
  std::vector<double> cell_displacement_;
  std::vector<PetscInt> rows_;
  std::size_t n_internal_;
};

constexpr double volume_tolerance = 1e-12; ///< a cell's or a pressure's shape function's, relative

/// The discrete equations of a scene: internal force = load factor * load, or those of its motion. Supports
/// are part of the equations: a step takes constrained degrees of freedom to where they have to be. Pressures
/// have no inertia.
class EquilibriumEquations : public mechanics::petsc::DistributedProblem<ElementEquations> {
 public:
  /// @param formulations  one for each of the discretisation's materials, which alone differ
  EquilibriumEquations(const Discretisation& discretisation, const std::vector<Formulation>& formulations);

  State rest() const override {
    return State::Zero(static_cast<Eigen::Index>(n_dofs() + assembly_.n_internal()));
  }

  void residual(const State& at, double load_factor, mechanics::Expect expect, State& residual) override;
  /// Constraints hold where volumes agree with pressures and supports are where they have to be.
  Size size(const State& /*residual*/, const State& /*at*/) override { return size_; }
  bool direction(const State& at, const State& residual, double load_factor, double forcing,
                 mechanics::Convexity convexity, State& step) override;
  /// Stability by the tangent last solved with.
  std::optional<bool> is_stable(const State& at) override;
  Work work() const override { return {solver_.n_iterations(), solver_.n_factorisations(), n_evaluations_}; }

  std::size_t n_unknowns() const override {
    return static_cast<std::size_t>(discretisation_.constraints.n_unknowns + discretisation_.n_pressures);
  }

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
  void supports_at(double time, State& displacement) const override;
  /// Completes a velocity whose own degrees of freedom are given: sets those of other ranks and, in a linear
  /// body, the pressures that belong to them.
  void complete(State& motion) override;
  /// Makes residuals those of the step, relative to its scale, whatever the load factor.
  void set_step(const mechanics::StepTerms& terms) override;
  void begin_motion(const State& at) override {
    if (assembly_.memory()) assembly_.memory()->begin(assembly_.elastic_stresses(at));
    if (contact_) contact_->forget();
  }
  void end_step(const State& at, double length) override {
    if (assembly_.memory()) assembly_.memory()->end_step(assembly_.elastic_stresses(at), length);
    largest_contact_force_ = std::max(largest_contact_force_, contact_force_);
    if (contact_) contact_->end_step(displacements(at), step_->time);
  }
  bool settle(const State& at) override {
    return !contact_ || contact_->settle(displacements(at), step_->time);
  }

  bool is_way_open(double from_time, const State& from, const State& to) const override {
    return !contact_ || contact_->is_way_open(displacements(from), from_time, displacements(to), step_->time);
  }

  void follow_tools(double from_time, const State& from, State& guess) const override;
  std::vector<cases::ToolContact> tools_at(double time, const State& at) const override;

  /// See Assembly.
  template<class Action>
  void for_each_cell(const State& state, const Action& action) {
    assembly_.for_each_cell(state, action);
  }

  /// The contact with the scene's tools; null: there are none.
  mechanics::Contact* contact() override { return contact_ ? &*contact_ : nullptr; }
  bool has_friction() const override { return contact_ && contact_->has_friction(); }

 private:
  std::size_t n_dofs() const { return discretisation_.constraints.is_constrained.size(); }
  void evaluate(const State& state, double load_factor, Wanted wanted);
  void evaluate_for_direction(const State& state, double load_factor);
  double load(std::size_t dof, double load_factor) const;
  void add_inertia(const State& state, Wanted wanted);
  void multiply(const LocalMatrix& matrix, const State& motion, State& product);
  void write(const State& from, Vec to) const;
  State with_ghosts(const State& motion);
  void set_inertia_force(const LocalMatrix& matrix, const State& motion);
  void add_to_tangent(const LocalMatrix& added);
  /// @param at  must outlive the result
  static mechanics::DisplacementAt displacements(const State& at) {
    return [&at](int node) -> Eigen::Vector3d { return at.segment<3>(3 * node); };
  }
  void add_contact(const State& state, double load_factor, Wanted wanted);
  bool has_nodal_pressures() const { return discretisation_.element.pressure == Pressure::nodes; }
  void measure(const std::optional<InternalImbalance>& internal, double load_factor);

  const Discretisation& discretisation_;
  Assembly assembly_;
  LinearSolver solver_;
  Vector force_; ///< imbalance of the last evaluation, zero on constrained degrees of freedom, N, mm³
  Vector right_hand_side_; ///< the Newton system's
  Vector correction_;      ///< its solution
  Vector inertia_force_;   ///< what a step in time adds
  struct Motion {
    Inertia inertia;
    LocalMatrix added; ///< mass M + damping C of the step, N/mm; its pattern is part of the tangent's
  };
  std::optional<Motion> motion_;              ///< present for a body in motion
  std::optional<mechanics::Contact> contact_; ///< with the scene's tools
  double contact_force_ = 0;                  ///< norm of its forces in the last evaluation, N
  double largest_contact_force_ = 0;          ///< at the end of a step
  long n_evaluations_ = 0, n_tangents_ = 0;
  bool has_tangent_ = false; ///< it was assembled at a valid state
  // results for the state last evaluated
  bool has_right_hand_side_ = false;
  Size size_ = {};                     ///< not finite: inverted at a quadrature point, or not a number
  std::vector<double> prescribed_gap_; ///< mm per local degree of freedom
};

} // namespace springproof::fem_reference
