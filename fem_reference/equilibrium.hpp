#pragma once

#include "fem_reference/discretisation.hpp"

namespace springproof::fem_reference {

/// Displacement of every degree of freedom (ghosts current) and the pressures of this rank's cells.
struct State {
  Vector displacement;          ///< mm
  std::vector<double> pressure; ///< MPa, n_pressure_modes per cell; empty without modes
};

/// How far a state is from equilibrium.
struct Imbalance {
  bool valid = false;  ///< false: inverted at a quadrature point, or not a number
  double residual = 0; ///< |imbalance on free degrees of freedom| / |applied load|
  double volume_mismatch =
      0; ///< largest relative volume a cell's pressure is wrong by (elements with pressure modes)
  double prescribed_gap = 0; ///< mm: largest distance of a fixed degree of freedom from its prescribed value
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

  /// Imbalance of a state; with a tangent wanted, the discretisation's matrix and right_hand_side() too.
  Imbalance evaluate(const State& state, double load_factor, Wanted wanted);

  /// The same with the tangent and right_hand_side(), but a tangent that cannot have changed since it was
  /// last assembled, a linear body's, is left as it is. The state's pressures are balanced: at rest or solved
  /// for.
  Imbalance evaluate_for_correction(const State& state, double load_factor);

  /// Completes a Newton correction whose displacement has been solved for: prescribed values and condensed
  /// pressures.
  void complete_correction(State& correction);

  /// Work of the imbalance of the last evaluate() on a correction, N mm: minus the line search's slope.
  double work(const State& correction) const;

  /// Deformed volume of this rank's cells, mm³, with the element's own displacement.
  std::vector<double> cell_volumes(const State& state);

  /// Calls of evaluate() so far.
  long n_evaluations() const { return n_evaluations_; }
  /// Tangents assembled so far.
  long n_tangents() const { return n_tangents_; }

  Vec right_hand_side() const { return right_hand_side_.get(); }
  const Discretisation& discretisation() const { return discretisation_; }
  /// Of the first material.
  const Formulation& formulation() const { return formulation_; }

 private:
  CellKernel& kernel(int cell);
  void begin_assembly(const State& state, double load_factor);
  bool add_cell(int cell, const double* displacement, const State& state, Wanted wanted);
  Imbalance measure(bool valid, double load_factor);
  void form_right_hand_side(double load_factor);
  double applied_norm() const;

  const Discretisation& discretisation_;
  Formulation formulation_;
  std::vector<CellKernel> kernels_; ///< one for each material
  Vector force_, condensed_force_,
      right_hand_side_; ///< internal force; with condensed imbalance; of the Newton system
  std::vector<double> local_force_, local_condensed_, prescribed_gap_;
  std::vector<double> pressure_residual_, pressure_slope_; ///< C^-1 R and C^-1 B of every cell
  std::vector<double> volume_residual_;                    ///< R of every cell, mm³
  double largest_mismatch_ = 0;
  double load_norm_ = 0;
  long n_evaluations_ = 0, n_tangents_ = 0;
  bool has_tangent_ = false; ///< one that was assembled at a valid state
};

} // namespace springproof::fem_reference
