#pragma once

#include "mechanics/hexahedron.hpp"

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

/// The same of a trilinear hexahedron by the 2x2x2 Gauss rule, as the finite elements have it: exact for
/// parallelepipeds, and for the sums of rows of others.
inline Eigen::MatrixXd shape_products(const HexahedronVertices& vertices, double density) {
  std::array<double, 64> shapes;
  std::array<double, 8> weights;
  for (int q = 0; q < 8; ++q) {
    const std::array<double, 8> shape = shape_values(gauss_point(q));
    for (std::size_t a = 0; a < 8; ++a) shapes[8 * static_cast<std::size_t>(q) + a] = shape[a];
    weights[static_cast<std::size_t>(q)] = jacobian(vertices, gauss_point(q)).determinant() / 8;
  }
  return shape_products(8, 8, shapes.data(), weights.data(), density);
}

} // namespace springproof::mechanics
