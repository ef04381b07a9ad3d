#pragma once

#include "fem_reference/assembly.hpp"

namespace springproof::fem_reference {

/// How far a state is from equilibrium.
struct Imbalance {
  bool valid = false;  ///< false: inverted at a quadrature point, or not a number
  double residual = 0; ///< |imbalance on unconstrained degrees of freedom| / |applied load|
  double volume_mismatch =
      0; ///< largest relative volume a cell's pressure is wrong by (elements with pressure modes)
  double prescribed_gap = 0; ///< mm: largest distance of a constrained displacement from its prescribed value
};

/// The discrete equilibrium equations of a scene: internal force = load factor * load.
class Equilibrium {
 public:
  Equilibrium(const Discretisation& discretisation, const Formulation& formulation)
      : Equilibrium(discretisation, std::vector<Formulation>{formulation}) {}
  /// @param formulations  of each of the discretisation's materials: one formulation, several materials
  Equilibrium(const Discretisation& discretisation, const std::vector<Formulation>& formulations);

  State rest() const;
  void copy(const State& from, State& to) const;
  /// to += factor * direction, ghosts included
  void advance(State& to, double factor, const State& direction) const;

  /// Imbalance of a state; with a tangent wanted, the tangent() and right_hand_side() too.
  Imbalance evaluate(const State& state, double load_factor, Wanted wanted);

  /// The same with the tangent() and right_hand_side(), but a tangent that cannot have changed since it was
  /// last assembled, a linear body's, is left as it is. The state's pressures are balanced: at rest or solved
  /// for.
  Imbalance evaluate_for_correction(const State& state, double load_factor);

  /// Completes a Newton correction whose displacement has been solved for: prescribed values and condensed
  /// pressures.
  void complete_correction(State& correction);

  /// Work of the imbalance of the last evaluate() on a correction, N mm: minus the line search's slope.
  double work(const State& correction) const;

  /// Deformed volume of this rank's cells, mm³, with the element's own displacement.
  std::vector<double> cell_volumes(const State& state) { return assembly_.cell_volumes(state); }

  /// Calls of evaluate() so far.
  long n_evaluations() const { return n_evaluations_; }
  /// Tangents assembled so far.
  long n_tangents() const { return n_tangents_; }

  Mat tangent() const { return assembly_.tangent(); }
  Vec right_hand_side() const { return right_hand_side_.get(); }
  const Discretisation& discretisation() const { return discretisation_; }
  /// Of the first material.
  const Formulation& formulation() const { return formulation_; }

 private:
  Imbalance measure(const Assembly::CellChecks& cells, double load_factor);
  double total(double value, MPI_Op operation) const;

  const Discretisation& discretisation_;
  Formulation formulation_;
  Assembly assembly_;
  Vector force_;           ///< imbalance of the last evaluation, zero on constrained degrees of freedom, N
  Vector right_hand_side_; ///< of the Newton system
  std::vector<double> prescribed_gap_; ///< mm per local degree of freedom
  double load_norm_ = 0;
  long n_evaluations_ = 0, n_tangents_ = 0;
  bool has_tangent_ = false; ///< one that was assembled at a valid state
};

} // namespace springproof::fem_reference
