#pragma once

#include "fem_reference/discretisation.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/laws/formulation.hpp"
#include "mechanics/equilibrium/nonlinear_problem.hpp"

namespace springproof::fem_reference {

/// Displacement of every local degree of freedom (ghosts current, mm), then the pressures of this rank's
/// cells (MPa, n_pressure_modes per cell).
using State = mechanics::Vector;

/// The loop over cells: internal forces, the assembled tangent, and what the condensed pressures need.
class Assembly {
 public:
  /// @param formulations  one for each of the discretisation's materials
  Assembly(const Discretisation& discretisation, const std::vector<Formulation>& formulations);

  /// @param gap        mm to the prescribed displacements, per local degree of freedom; 0 where unconstrained
  /// @param force      becomes the internal force, N
  /// @param condensed  when a tangent is wanted, becomes the internal force with the pressures' imbalance and
  ///                   what the gap will add to it, N
  /// @return the largest volume mismatch of this rank's cells; nothing when one of them is inverted at a
  ///         quadrature point, or not a number: sums are then incomplete
  std::optional<double> assemble(const State& state, const std::vector<double>& gap, Wanted wanted, Vec force,
                                 Vec condensed);

  /// Sets the pressures that belong to a correction's displacement.
  void complete_correction(State& correction) const;
  /// Takes the pressures of the current state as balanced, for a linear body's next correction.
  void pressures_are_balanced();
  /// Deformed volume of this rank's cells, mm³, with the element's own displacement.
  std::vector<double> cell_volumes(const State& state);
  /// Adds this rank's cells to fields on the body's own mesh.
  /// @param n_refinements  number of refinements from the body's own mesh to the discretisation's
  void add_fields(const State& state, int n_refinements, ElementFields& fields);
  void add_norms(const State& state, DisplacementNorms& norms);

  std::size_t n_pressures() const { return pressure_residual_.size(); }
  Mat tangent() const { return tangent_.get(); }

 private:
  CellKernel& kernel(int cell) const;
  const double* pressure(int cell, const State& state) const;
  /// Displacement of a cell's nodes, mm, kept until the next call.
  const double* displacement(int cell, const State& state);
  const CellResult& evaluate(int cell, const State& state, Wanted wanted);
  void add_tangent(int cell, const CellResult& result, const std::vector<double>& gap,
                   const WriteEntries& condensed);
  /// Local degree of freedom k of a cell, in the order of its forces.
  std::size_t dof(int cell, std::size_t k) const;
  std::size_t n_displacements() const { return discretisation_.constraints.is_constrained.size(); }

  const Discretisation& discretisation_;
  std::vector<std::unique_ptr<CellKernel>> kernels_; ///< one for each material
  Matrix tangent_;
  std::vector<double> pressure_residual_, pressure_slope_; ///< C^-1 R and C^-1 B of every cell
  std::vector<double> cell_displacement_;
  std::vector<PetscInt> rows_;
};

} // namespace springproof::fem_reference
