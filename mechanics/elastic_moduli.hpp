#pragma once

#include "cases/case/case.hpp"

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

/// Returns the material with a given shear and bulk modulus, MPa.
inline cases::LinearElastic linear_elastic(double mu, double kappa) {
  return {9 * kappa * mu / (3 * kappa + mu), (3 * kappa - 2 * mu) / (2 * (3 * kappa + mu))};
}

/// Bulk modulus over initial shear modulus of a hyperelastic material that names none: the volume of the
/// thesis's cube changes by less than 0.1 % under every load, its bar's deflection by 0.02 % from that at
/// twice the ratio.
constexpr double nearly_incompressible_ratio = 1000;

inline ElasticModuli elastic_moduli(const cases::HyperelasticRest& rest) {
  const double mu = rest.shear_modulus, kappa = rest.bulk_modulus.value_or(nearly_incompressible_ratio * mu);
  return {kappa - 2 * mu / 3, mu, kappa};
}

/// Elasticity of a transversely isotropic material in axes of its own, the third along the fibre, MPa:
/// stresses 11, 22, 33 are c11 e11 + c12 e22 + c13 e33, c12 e11 + c11 e22 + c13 e33 and c13 (e11 + e22) +
/// c33 e33; shear stresses 13 and 23 are c44 times the engineering shear, 12 is c66 times it, which is
/// (c11 - c12)/2 where the material is isotropic across the fibre.
struct TransverseModuli {
  double c11, c12, c13, c33, c44, c66;

  /// Pressure over loss of volume of a body under pressure from all sides, MPa: 1/(1 : C^-1 : 1).
  double bulk_modulus;
};

/// The inverse of the compliance of the engineering constants.
inline TransverseModuli transverse_moduli(const cases::TransverselyIsotropic& m) {
  const double along = m.youngs_modulus_along, across = m.youngs_modulus_across;
  const double nu = m.poissons_ratio_across, coupling = m.poissons_ratio_along;
  // E_T/E_L nu_LT² = nu_LT nu_TL
  const double product = across / along * coupling * coupling;
  const double m0 = 1 - nu - 2 * product; // > 0: the energy is positive
  return {across * (1 - product) / ((1 + nu) * m0),
          across * (nu + product) / ((1 + nu) * m0),
          across * coupling / m0,
          along * (1 - nu) / m0,
          m.shear_modulus_along,
          across / (2 * (1 + nu)),
          1 / ((1 - 4 * coupling) / along + 2 * (1 - nu) / across)};
}

/// The engineering constants of such moduli; without a fibre.
inline cases::TransverselyIsotropic engineering_constants(const TransverseModuli& c) {
  const double sum = c.c11 + c.c12, determinant = c.c33 * sum - 2 * c.c13 * c.c13;
  const double normal = c.c11 * c.c33 - c.c13 * c.c13;
  return {determinant / sum,
          (c.c11 - c.c12) * determinant / normal,
          c.c13 / sum,
          (c.c12 * c.c33 - c.c13 * c.c13) / normal,
          c.c44,
          Eigen::Vector3d::Zero()};
}

} // namespace springproof::mechanics
