#include "fem_reference/laws/principal_stretches.hpp"

#include <cmath>
#include <numeric>

namespace springproof::fem_reference {

namespace {

/// tau_i = sum_p 2 mu_p/alpha_p (s_i - (s_1 + s_2 + s_3)/3), s_i = (isochoric stretch i)^alpha_p.
PrincipalStress isochoric_stress(const cases::Ogden& material, const Eigen::Vector3d& x, Wanted wanted) {
  const Eigen::Vector3d isochoric = x.array() - x.mean();
  PrincipalStress s{Eigen::Vector3d::Zero(), Matrix3::Zero(), Eigen::Vector3d::Zero()};
  for (std::size_t term = 0; term < material.mu.size(); ++term) {
    const double mu = material.mu[term], alpha = material.alpha[term];
    const Eigen::Vector3d power = (alpha * isochoric.array()).exp();
    const double mean = power.mean();
    s.kirchhoff += 2 * mu / alpha * (power.array() - mean).matrix();
    if (wanted == Wanted::stress) continue;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        s.slope(i, j) += 2 * mu * ((i == j ? power(i) : 0) - (power(i) + power(j) - mean) / 3);
    for (int p = 0; p < 3; ++p) {
      // e^(alpha a) - e^(alpha b) over e^2a' - e^2b' with isochoric a, b and true a', b'; a - b = a' - b'
      const int i = (p + 1) % 3, j = (p + 2) % 3;
      const double centre = alpha * (isochoric(i) + isochoric(j)) / 2 - (x(i) + x(j));
      s.difference(p) += 2 * mu / alpha * std::exp(centre) * sinh_ratio(alpha / 2, x(i) - x(j));
    }
  }
  return s;
}

} // namespace

/// W = sum 2 mu/alpha² (isochoric stretches^alpha - 3) + kappa/4 (J² - 1 - 2 ln J), so p = kappa/2 (J - 1/J).
Formulation ogden(const cases::Ogden& material) {
  const double shear = std::accumulate(material.mu.begin(), material.mu.end(), 0.);
  const double kappa = material.bulk_modulus.value_or(nearly_incompressible_ratio * shear);
  const auto isochoric = in_principal_stretches(
      [material](const Eigen::Vector3d& x, Wanted wanted) { return isochoric_stress(material, x, wanted); });
  const VolumetricLaw volumetric{
      [kappa](double j) {
        return ValueAndSlope{kappa / 2 * (j - 1 / j), kappa / 2 * (1 + 1 / (j * j))};
      },
      [kappa](double p) { // the positive root of J² - 2 p/kappa J - 1 = 0; for p < 0 without cancellation
        const double q = p / kappa, root = std::sqrt(q * q + 1);
        const double j = q >= 0 ? q + root : 1 / (root - q);
        return ValueAndSlope{j, j / (root * kappa)};
      }};
  return {isochoric, volumetric, Kinematics::finite, TangentSymmetry::symmetric};
}

} // namespace springproof::fem_reference
