#pragma once

#include <Eigen/Dense>
#include <array>

/// The linear tetrahedral finite element of the St. Venant-Kirchhoff material, from the deformation gradient:
/// what biquadratic springs are held against. Nothing here is shared with them.
namespace linear_tetrahedron {

using Positions = std::array<Eigen::Vector3d, 4>; // mm

inline Eigen::Matrix3d edges(const Positions& x) {
  Eigen::Matrix3d columns;
  columns << x[1] - x[0], x[2] - x[0], x[3] - x[0];
  return columns;
}

inline Eigen::Matrix3d deformation_gradient(const Positions& rest, const Positions& x) {
  return edges(x) * edges(rest).inverse();
}

inline Eigen::Matrix3d green_strain(const Eigen::Matrix3d& f) {
  return 0.5 * (f.transpose() * f - Eigen::Matrix3d::Identity());
}

/// N mm
inline double energy(const Positions& rest, const Positions& x, double lambda, double mu) {
  const Eigen::Matrix3d e = green_strain(deformation_gradient(rest, x));
  const double volume = edges(rest).determinant() / 6;
  return volume * (mu * e.squaredNorm() + 0.5 * lambda * e.trace() * e.trace());
}

/// N, on the vertices: minus V P grad N, P = F (lambda tr(E) I + 2 mu E).
inline Positions forces(const Positions& rest, const Positions& x, double lambda, double mu) {
  const Eigen::Matrix3d f = deformation_gradient(rest, x), e = green_strain(f);
  const Eigen::Matrix3d stress = f * (lambda * e.trace() * Eigen::Matrix3d::Identity() + 2 * mu * e);
  const Eigen::Matrix3d per_vertex =
      -edges(rest).determinant() / 6 * stress * edges(rest).inverse().transpose();
  return {-per_vertex.rowwise().sum(), per_vertex.col(0), per_vertex.col(1), per_vertex.col(2)};
}

} // namespace linear_tetrahedron
