#pragma once

#include "fem_reference/element.hpp"

namespace springproof::fem_reference {

/// Shape functions on the unit interval and their slopes at x, for nodes at 0, 1/degree, ... 1.
struct IntervalShapes {
  double value[3], slope[3];
};
IntervalShapes interval_shapes(int degree, double x);

/// Shape functions of an element that is a cuboid along the axes, at rest: all elements of a grid. Node
/// i + n j + n² k, n = degree + 1, lies at (i, j, k)/degree of the unit cube; Gauss points are counted
/// likewise.
class Cuboid {
 public:
  /// @param n_pressure_modes  0 or 1     @param edges  mm     @param n_bubbles  0 or 3
  Cuboid(int degree, int n_pressure_modes, const Eigen::Vector3d& edges, int n_bubbles = 0);

  /// Points into this.
  CellGeometry geometry() const;
  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; } ///< in the unit cube
  const std::vector<double>& values() const { return values_; }        ///< N_a at point q: [q*n_nodes + a]

 private:
  int n_bubbles_;
  std::vector<Eigen::Vector3d> nodes_;
  std::vector<double> values_, gradients_, weights_, modes_;
};

} // namespace springproof::fem_reference
