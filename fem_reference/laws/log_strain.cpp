#include "fem_reference/laws/principal_stretches.hpp"

#include <cmath>

namespace springproof::fem_reference {

namespace {

/// J dev(sigma) = 2 mu J dev(ln V).
PrincipalStress deviatoric_stress(double mu, const Eigen::Vector3d& x, Wanted wanted) {
  const double two_mu_j = 2 * mu * std::exp(x.sum());
  const Eigen::Vector3d deviator = x.array() - x.mean();
  PrincipalStress s;
  s.kirchhoff = two_mu_j * deviator;
  if (wanted == Wanted::stress) return s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s.slope(i, j) = two_mu_j * ((i == j ? 1. : 0.) - 1. / 3 + deviator(i));
  for (int p = 0; p < 3; ++p) {
    const double a = x((p + 1) % 3), b = x((p + 2) % 3), d = a - b;
    // (a - b)/(e^2a - e^2b) = e^-(a+b) d/(2 sinh d), and d/sinh d = 1 - d²/6 to 1e-14 for d < 1e-3
    const double ratio = std::abs(d) > 1e-3 ? d / std::sinh(d) : 1 - d * d / 6 * (1 - 7 * d * d / 60);
    s.difference(p) = two_mu_j * std::exp(-(a + b)) * ratio / 2;
  }
  return s;
}

} // namespace

/// Cauchy stress sigma = lambda tr(e) I + 2 mu e, e = ln V: deviator 2 mu dev(e), pressure kappa ln J. Path
/// independent, but no energy belongs to it: its tangent is slightly unsymmetric.
Formulation log_strain(const cases::LinearElastic& material) {
  const auto [lambda, mu, kappa] = elastic_moduli(material);
  const auto deviatoric = in_principal_stretches(
      [m = mu](const Eigen::Vector3d& x, Wanted wanted) { return deviatoric_stress(m, x, wanted); });
  const VolumetricLaw volumetric{[k = kappa](double j) {
                                   return ValueAndSlope{k * std::log(j), k / j};
                                 },
                                 [k = kappa](double p) {
                                   const double j = std::exp(p / k);
                                   return ValueAndSlope{j, j / k};
                                 }};
  return {deviatoric, volumetric, Kinematics::finite, TangentSymmetry::unsymmetric};
}

} // namespace springproof::fem_reference
