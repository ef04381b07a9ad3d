#pragma once

#include "fem_reference/element.hpp"

namespace springproof::fem_reference {

/// Shape functions of an element that is a cuboid along the axes, at rest: all elements of a grid. Node
/// i + n j + n² k, n = degree + 1, lies at (i, j, k)/degree of the unit cube.
class Cuboid {
 public:
  /// @param edges  mm
  Cuboid(const ElementType& element, const Eigen::Vector3d& edges);

  /// Points into this.
  CellGeometry geometry() const;
  const std::vector<Eigen::Vector3d>& nodes() const { return nodes_; } ///< in the unit cube

 private:
  std::vector<Eigen::Vector3d> nodes_;
  std::vector<double> gradients_, weights_, modes_;
};

} // namespace springproof::fem_reference
