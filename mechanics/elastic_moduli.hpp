#pragma once

#include "cases/case/case.hpp"

#include <numeric>

namespace springproof::mechanics {

/// Moduli of isotropic linear elasticity, MPa.
struct ElasticModuli {
  double lambda, mu, kappa;
};

inline ElasticModuli elastic_moduli(const cases::LinearElastic& material) {
  const double mu = material.youngs_modulus / (2 * (1 + material.poissons_ratio));
  const double lambda = 2 * mu * material.poissons_ratio / (1 - 2 * material.poissons_ratio);
  return {lambda, mu, lambda + 2 * mu / 3};
}

/// The material of a shear and a bulk modulus, MPa.
inline cases::LinearElastic linear_elastic(double mu, double kappa) {
  return {9 * kappa * mu / (3 * kappa + mu), (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu))};
}

/// Shear modulus at rest, MPa.
inline double shear_modulus(const cases::Ogden& material) {
  return std::accumulate(material.mu.begin(), material.mu.end(), 0.);
}

/// Bulk modulus over initial shear modulus of an Ogden material that names none: the volume of the thesis's
/// cube changes by less than 0.1 % under every load, its bar's deflection by 0.02 % from that at twice the
/// ratio.
constexpr double nearly_incompressible_ratio = 1000;

/// Bulk modulus, MPa.
inline double bulk_modulus(const cases::Ogden& material) {
  return material.bulk_modulus.value_or(nearly_incompressible_ratio * shear_modulus(material));
}

} // namespace springproof::mechanics
