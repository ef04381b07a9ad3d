#pragma once

#include "fem_reference/equations.hpp"

using namespace springproof;

/// The tangent of a body of one cell, its pressures eliminated, those of its vertices too.
Eigen::MatrixXd condensed_tangent(const fem_reference::CellResult& cell);

/// What verification needs beyond a case. None: zero.
struct Prescribed {
  using Field = std::function<Eigen::Vector3d(const Eigen::Vector3d& rest_point)>;
  Field body_force;   ///< N/mm³ at rest
  Field displacement; ///< mm, on constrained components
};

/// A scene solved under body forces and prescribed displacements, with its degrees of freedom in view.
struct Solved {
  fem_reference::Formulation formulation;
  fem_reference::Discretisation discretisation;
  fem_reference::EquilibriumEquations equations;
  fem_reference::State state;

  /// @throws SolveError
  Solved(const cases::Scene& scene, const Prescribed& prescribed);

  using Field = Prescribed::Field;

  /// Displacement of each local node (one rank: of every node), mm.
  std::vector<Eigen::Vector3d> displacement() const;
  /// Largest distance of a node's displacement from a field, mm.
  double largest_error(const Field& exact) const;
  /// L2 norm of the displacement's error over the rest body by the element's own quadrature, mm^(5/2).
  double l2_error(const Field& exact) const;
  /// Sum of internal forces on the nodes at which `selected` holds, N: what supports and loads there add up
  /// to.
  Eigen::Vector3d force_on(const std::function<bool(const Eigen::Vector3d& rest_point)>& selected) const;
};
