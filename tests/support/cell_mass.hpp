#pragma once

#include "mechanics/hexahedron.hpp"

#include <Eigen/LU>

namespace springproof::mechanics {

/// Consistent mass matrix of a trilinear hexahedron, in the unit of density times mm³; degree of freedom
/// 3*vertex + component. M_ab = integral of density N_a N_b over the cell at rest, 2x2x2 Gauss, which is
/// exact for parallelepipeds. The entries of one component sum up to the cell's mass.
inline Eigen::Matrix<double, 24, 24> consistent_mass(const HexahedronVertices& vertices, double density) {
  Eigen::Matrix<double, 24, 24> mass = Eigen::Matrix<double, 24, 24>::Zero();
  for (int q = 0; q < 8; ++q) {
    const Eigen::Vector3d at = gauss_point(q);
    const std::array<double, 8> shape = shape_values(at);
    const double weight = density * jacobian(vertices, at).determinant() / 8;
    for (int v = 0; v < 8; ++v)
      for (int w = 0; w < 8; ++w)
        mass.block<3, 3>(3 * v, 3 * w).diagonal().array() +=
            weight * shape[static_cast<std::size_t>(v)] * shape[static_cast<std::size_t>(w)];
  }
  return mass;
}

} // namespace springproof::mechanics
