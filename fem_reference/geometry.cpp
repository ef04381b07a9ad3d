#include "fem_reference/geometry.hpp"

#include "cases/case/index.hpp"
#include "fem_reference/space.hpp"

#include <cmath>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

Geometry::Geometry(const Space& space, const Nodes& nodes, const ElementType& element)
    : nodes_(nodes), n_modes_(element.n_pressure_modes) {
  const dealii::QGauss<3> quadrature(static_cast<unsigned>(element.degree) + 1);
  dealii::FEValues<3> values(space.mapping, space.node_element, quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  n_points = static_cast<int>(quadrature.size());
  for (const auto& at : quadrature.get_points())
    for (unsigned a = 0; a < space.node_element.n_dofs_per_cell(); ++a)
      shape_values.push_back(space.node_element.shape_value(a, at));
  gradients_.reserve(3 * index(nodes.n_cells) * shape_values.size());
  int n_cells = 0;
  for (const auto& cell : space.own_cells()) {
    values.reinit(static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell));
    for (const unsigned q : values.quadrature_point_indices()) {
      weights_.push_back(values.JxW(q));
      for (unsigned j = 0; j < 3; ++j)
        for (const unsigned a : values.dof_indices()) gradients_.push_back(values.shape_grad(a, q)[j]);
    }
    add_pressure_modes(n_cells++);
  }
}

/// 1 and the coordinates from the cell's centre over its edge length. Coordinates of the reference cell would
/// lose an order of accuracy on cells that are no parallelepipeds (Arnold, Boffi and Falk, Math. Comp. 71,
/// 2002).
void Geometry::add_pressure_modes(int cell) {
  if (n_modes_ == 0) return;
  const double* weights = weights_.data() + cell * n_points;
  Vector3d centre = Vector3d::Zero();
  double volume = 0;
  for (int q = 0; q < n_points; ++q) {
    centre += weights[q] * point(cell, q);
    volume += weights[q];
  }
  centre /= volume;
  for (int q = 0; q < n_points; ++q) {
    const Vector3d offset = (point(cell, q) - centre) / std::cbrt(volume);
    for (int m = 0; m < n_modes_; ++m) modes_.push_back(m == 0 ? 1 : offset[m - 1]);
  }
}

CellGeometry Geometry::of(int cell) const {
  const auto first = index(cell) * index(n_points);
  return {nodes_.per_cell, n_points, gradients_.data() + first * 3 * index(nodes_.per_cell),
          weights_.data() + first, modes_.data() + first * index(n_modes_)};
}

Vector3d Geometry::point(int cell, int q) const {
  const auto n = index(nodes_.per_cell);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t a = 0; a < n; ++a)
    sum += shape_values[index(q) * n + a] * nodes_.point[index(nodes_.of_cell[index(cell) * n + a])];
  return sum;
}

} // namespace springproof::fem_reference
