#pragma once

#include "mechanics/elastic_moduli.hpp"
#include "mechanics/laws/point.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <vector>

/// Laws evaluated for one number, with the parameters of a case's material.
namespace springproof::mechanics {

template<>
struct Parameters<double> {
  std::vector<double> value;
  int n;
};

inline Parameters<double> parameters_of(const cases::LinearElastic& material) {
  const ElasticModuli moduli = elastic_moduli(material);
  return {{moduli.mu, moduli.kappa}, 2};
}
inline Parameters<double> parameters_of(const cases::Ogden& material) {
  std::vector<double> values{elastic_moduli(cases::at_rest(material)).kappa};
  for (std::size_t term = 0; term < material.mu.size(); ++term)
    values.insert(values.end(), {material.mu[term], material.alpha[term]});
  const auto n = static_cast<int>(values.size());
  return {std::move(values), n};
}
inline Parameters<double> parameters_of(const cases::Yeoh& material) {
  return {{elastic_moduli(cases::at_rest(material)).kappa, material.c10, material.c20, material.c30}, 4};
}

/// The part of the Kirchhoff stress that is no pressure, in principal axes, MPa.
/// @tparam Law  in principal stretches (laws/in_principal_stretches.hpp)
/// @param x     logarithmic stretches
template<class Law>
Eigen::Vector3d kirchhoff_stress(const Parameters<double>& parameters, const Eigen::Vector3d& x) {
  const double logarithms[3] = {x[0], x[1], x[2]};
  double tau[3];
  Law::kirchhoff(logarithms, parameters, tau);
  return {tau[0], tau[1], tau[2]};
}

/// A law's Cauchy stress without its pressure, MPa.
template<class Law>
Eigen::Matrix3d cauchy_stress_without_pressure(const Parameters<double>& parameters,
                                               const Eigen::Matrix3d& deformation_gradient) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> left(deformation_gradient *
                                                            deformation_gradient.transpose());
  const Eigen::Vector3d x = left.eigenvalues().array().log() / 2;
  const Eigen::Vector3d principal = kirchhoff_stress<Law>(parameters, x) / std::exp(x.sum());
  return left.eigenvectors() * principal.asDiagonal() * left.eigenvectors().transpose();
}

} // namespace springproof::mechanics
