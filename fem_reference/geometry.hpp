#pragma once

#include "fem_reference/element.hpp"
#include "fem_reference/nodes.hpp"

namespace springproof::fem_reference {

/// Shape functions, gradients, weights and pressure modes at the quadrature points of a rank's cells at rest.
class Geometry {
 public:
  Geometry(const Space& space, const Nodes& nodes, const ElementType& element);

  int n_points = 0;                 ///< per cell
  std::vector<double> shape_values; ///< N_a at point q: [q*n_nodes + a]

  CellGeometry of(int cell) const;
  /// Rest position of a quadrature point, mm.
  Eigen::Vector3d point(int cell, int q) const;

 private:
  void add_pressure_modes(int cell);

  const Nodes& nodes_;
  int n_modes_;
  std::vector<double> gradients_, weights_, modes_;
};

} // namespace springproof::fem_reference
