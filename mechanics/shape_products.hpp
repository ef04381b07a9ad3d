#pragma once

#include "cases/mesh/cell_shape.hpp"

#include <Eigen/LU>

/// Consistent masses of a cell of any shape.
namespace springproof::mechanics {

/// Density times the integrals of N_a N_b, t, by a rule of n_points points.
/// @param n             nodes
/// @param shape_values  N_a at point q: [q*n + a]
/// @param weights       the points', mm³
inline Eigen::MatrixXd shape_products(int n, int n_points, const double* shape_values, const double* weights,
                                      double density) {
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, n);
  for (int q = 0; q < n_points; ++q) {
    const Eigen::Map<const Eigen::VectorXd> shape(shape_values + q * n, n);
    products += density * weights[q] * shape * shape.transpose();
  }
  return products;
}

/// The same of a cell by the rule of its reference cell, as the finite elements have it: exact for
/// parallelepipeds and tetrahedra, and for the sums of rows of other hexahedra.
inline Eigen::MatrixXd shape_products(const cases::CellCorners& corners, double density) {
  const cases::ReferenceCell& cell = cases::reference_cell(cases::shape_of(corners.size()));
  std::vector<double> shapes, weights;
  for (const Eigen::Vector3d& point : cell.points) {
    const cases::ShapeValues shape = cases::shape_values(cell.shape, point);
    shapes.insert(shapes.end(), shape.begin(), shape.end());
    weights.push_back(cases::jacobian(corners, point).determinant() * cell.volume /
                      double(cell.points.size()));
  }
  return shape_products(static_cast<int>(corners.size()), static_cast<int>(weights.size()), shapes.data(),
                        weights.data(), density);
}

} // namespace springproof::mechanics
