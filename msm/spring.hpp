#pragma once

#include <Eigen/Core>
#include <cmath>

namespace springproof::msm {

struct Spring {
  double stiffness;   ///< N/mm
  double rest_length; ///< mm, > 0
};

/// Energy of a spring, k/2 (|d| - l0)², d = x_j - x_i.  @param d  mm  @return N mm
inline double spring_energy(const Eigen::Vector3d& d, const Spring& spring) {
  const double elongation = d.norm() - spring.rest_length;
  return 0.5 * spring.stiffness * elongation * elongation;
}

/// Force on point i from the spring (i, j):  f = k (|d| - l0) d / |d|,  d = x_j - x_i: it pulls i towards j
/// when stretched; point j receives the opposite. The points must not coincide.
/// @param d  x_j - x_i, mm  @return N
/// Source: thesis eq. 4.8; minus the gradient of spring_energy() with respect to x_i.
inline Eigen::Vector3d spring_force(const Eigen::Vector3d& d, const Spring& spring) {
  const double length = d.norm();
  return (spring.stiffness * (1 - spring.rest_length / length)) * d;
}

enum class TransverseTerm { exact, clamped };

/// Second derivative of spring_energy() with respect to d:
///   k n n^T + k (1 - l0/|d|) (I - n n^T),  n = d/|d|.
/// The transverse factor is negative in a compressed spring; clamped, it is at least 0 and the matrix
/// positive semidefinite.
/// @param d  mm  @return N/mm, symmetric; the (i, i) and (j, j) blocks of the tangent get it, (i, j) its
/// negative
inline Eigen::Matrix3d spring_stiffness(const Eigen::Vector3d& d, const Spring& spring, TransverseTerm term) {
  const double length_squared = d.squaredNorm();
  double transverse = spring.stiffness * (1 - spring.rest_length / std::sqrt(length_squared));
  if (term == TransverseTerm::clamped && transverse < 0) transverse = 0;
  return transverse * Eigen::Matrix3d::Identity() +
         ((spring.stiffness - transverse) / length_squared) * d * d.transpose();
}

} // namespace springproof::msm
