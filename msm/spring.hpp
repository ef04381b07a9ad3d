#pragma once

#include "mechanics/ramp_integral.hpp"

#include <Eigen/Core>
#include <cmath>
#include <optional>

namespace springproof::msm {

/// A spring's law: how its tension T follows its stretch q = |d|/l0. Hooke's is T = k l0 (q - 1), or
/// k (|d| - l0). The power-log law is T = k l0 q^p ln q: of the same stiffness k at rest, and of the second
/// derivative (2p - 1) k/l0 there, so that the exponent p decides whether it stiffens or softens.
struct Spring {
  double stiffness;                 ///< k at rest, N/mm
  double rest_length;               ///< l0, mm, > 0
  std::optional<double> exponent{}; ///< p of the power-log law; without one, Hooke's
};

/// ln q of a spring's stretch, without the digits that q = 1.000... would lose.
inline double log_stretch(double length, const Spring& spring) {
  return std::log1p((length - spring.rest_length) / spring.rest_length);
}

/// The integral of q^p ln q from 1, of y = ln q:  y² times ramp_integral((p + 1) y).
inline double power_log_integral(double log, double exponent) {
  return mechanics::ramp_integral((exponent + 1) * log) * log * log;
}

/// Energy of a spring: Hooke's is k/2 (|d| - l0)².  @param d  x_j - x_i, mm  @return N mm
inline double spring_energy(const Eigen::Vector3d& d, const Spring& spring) {
  const double length = d.norm(), rest = spring.rest_length, k = spring.stiffness;
  if (spring.exponent)
    return k * rest * rest * power_log_integral(log_stretch(length, spring), *spring.exponent);
  return 0.5 * k * (length - rest) * (length - rest);
}

/// What a spring's second derivative is made of.
struct SpringSlopes {
  double along;      ///< dT/d|d|, N/mm
  double transverse; ///< T/|d|, N/mm
};

inline SpringSlopes spring_slopes(double length, const Spring& spring) {
  const double k = spring.stiffness;
  if (!spring.exponent) return {k, k * (1 - spring.rest_length / length)};
  const double log = log_stretch(length, spring), power = k * std::exp((*spring.exponent - 1) * log);
  return {power * (*spring.exponent * log + 1), power * log};
}

/// Force on point i from the spring (i, j):  f = T d/|d|,  d = x_j - x_i: it pulls i towards j when
/// stretched; point j receives the opposite. The points must not coincide.
/// @param d  x_j - x_i, mm  @return N
/// Source: thesis eq. 4.8 (Hooke); minus the gradient of spring_energy() with respect to x_i.
inline Eigen::Vector3d spring_force(const Eigen::Vector3d& d, const Spring& spring) {
  return spring_slopes(d.norm(), spring).transverse * d;
}

enum class TransverseTerm { exact, clamped };

/// Second derivative of spring_energy() with respect to d:
///   dT/d|d| n n^T + T/|d| (I - n n^T),  n = d/|d|.
/// The transverse factor is negative in a compressed spring, the other one where a power-log spring has
/// passed its largest tension; clamped, both are at least 0 and the matrix positive semidefinite.
/// @param d  mm  @return N/mm, symmetric; the (i, i) and (j, j) blocks of the tangent get it, (i, j) its
/// negative
inline Eigen::Matrix3d spring_stiffness(const Eigen::Vector3d& d, const Spring& spring, TransverseTerm term) {
  const double length_squared = d.squaredNorm();
  auto [along, transverse] = spring_slopes(std::sqrt(length_squared), spring);
  if (term == TransverseTerm::clamped) {
    if (transverse < 0) transverse = 0;
    if (along < 0 && spring.exponent) along = 0; // Hooke's k < 0 is a property of the lattice
  }
  return transverse * Eigen::Matrix3d::Identity() +
         ((along - transverse) / length_squared) * d * d.transpose();
}

/// A volume term's law: its pressure (tension-positive) as a function of the volume ratio J of the cell, over
/// k_v, with its integral from 1 and its derivative. Linear beside Hooke's springs: J - 1; logarithmic beside
/// power-log springs: ln J, which is no number at J <= 0, so that no state with such a cell is accepted.
struct VolumeLaw {
  double integral, pressure, slope;
};
inline VolumeLaw volume_law(double volume_ratio, bool is_logarithmic) {
  const double j = volume_ratio;
  if (!is_logarithmic) return {0.5 * (j - 1) * (j - 1), j - 1, 1};
  const double log = std::log(j);
  return {power_log_integral(log, 0), log, 1 / j};
}

} // namespace springproof::msm
