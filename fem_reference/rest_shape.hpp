#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/cell_shape.hpp"
#include "fem_reference/element.hpp"

#include <Eigen/Core>
#include <vector>

namespace springproof::fem_reference {

/// A cell whose nodes are its vertices, at rest: gradients and weights at the points of its element, 2x2x2
/// Gauss points of a hexahedron or the one of a tetrahedron, and a constant mode.
class RestShape {
 public:
  /// @param corners  mm
  /// @throws InputError for an inverted or degenerate cell
  explicit RestShape(const cases::CellCorners& corners);

  /// Points into this.
  CellGeometry geometry() const;
  int n_nodes() const { return n_nodes_; }
  double volume() const { return volume_; } ///< mm³
  /// Mean of dN_a/dX over the cell, a column a vertex, 1/mm.
  const cases::ShapeGradients& mean_gradients() const { return mean_gradients_; }

 private:
  int n_nodes_;
  double volume_ = 0;
  std::vector<double> gradients_, weights_, modes_;
  cases::ShapeGradients mean_gradients_;
};

/// Stiffness matrix of such a cell, N/mm; degree of freedom 3*vertex + component.
/// @param element  of degree 1, with no pressure or a constant one
Eigen::MatrixXd stiffness_of(const RestShape& shape, const cases::LinearElastic& material,
                             cases::Element element);

} // namespace springproof::fem_reference
