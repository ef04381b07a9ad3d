#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>

/// Isotropic laws in principal axes, for finite elements and for the designs of springs. A law has
///   PrincipalStress stress(log_stretches, wanted)  the part of the Kirchhoff stress that is no pressure,
///   ValueAndSlope pressure(dilatation)             tension-positive mean Cauchy stress, MPa, of J - 1,
///   ValueAndSlope dilatation(pressure)             its inverse,
///   double energy(log_stretches)                   without that of the pressure, and
///   double volume_energy(dilatation)               the pressure's integral, N mm per mm³ at rest,
///   has_energy                                     whether its tangent is symmetric,
///   Material                                       what it is made from: of the case's materials.
namespace springproof::mechanics {

enum class Wanted { stress, stress_and_tangent };

/// A function's value and its derivative.
struct ValueAndSlope {
  double value;
  double slope;
};

/// An isotropic stress in principal axes, as a function of the logarithmic stretches x_i = ln lambda_i.
struct PrincipalStress {
  Eigen::Vector3d kirchhoff;  ///< tau_i, MPa
  Eigen::Matrix3d slope;      ///< d tau_i/d x_j, MPa
  Eigen::Vector3d difference; ///< (tau_i - tau_j)/(lambda_i² - lambda_j²) for the pairs (1,2), (2,0), (0,1),
                              ///< at their limit when the stretches coincide
};

/// sinh(a d)/sinh(d), to rounding error for every d; a at d = 0.
inline double sinh_ratio(double a, double d) {
  if (std::abs(d) > 1e-3) return std::sinh(a * d) / std::sinh(d);
  // a (1 + (a²-1) d²/6 + (a²-1)(3a²-7) d⁴/360): the next term is below 1e-17 a⁶ here
  const double square = d * d, excess = a * a - 1;
  return a * (1 + excess * square / 6 * (1 + (3 * a * a - 7) * square / 60));
}

/// A law's Cauchy stress without its pressure, MPa.
template<class Law>
Eigen::Matrix3d cauchy_stress_without_pressure(const Law& law, const Eigen::Matrix3d& deformation_gradient) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> left(deformation_gradient *
                                                            deformation_gradient.transpose());
  const Eigen::Vector3d x = left.eigenvalues().array().log() / 2;
  const Eigen::Vector3d principal = law.stress(x, Wanted::stress).kirchhoff / std::exp(x.sum());
  return left.eigenvectors() * principal.asDiagonal() * left.eigenvectors().transpose();
}

} // namespace springproof::mechanics
