#pragma once

#include "mechanics/elastic_moduli.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "mechanics/ramp_integral.hpp"

namespace springproof::mechanics {

/// Cauchy stress sigma = lambda tr(e) I + 2 mu e, e = ln V: deviator 2 mu dev(e), pressure kappa ln J. Path
/// independent, but no energy belongs to it: its tangent is slightly unsymmetric.
class LogStrain {
 public:
  using Material = cases::LinearElastic;
  static constexpr bool has_energy = false;

  explicit LogStrain(const Material& material) : moduli_(elastic_moduli(material)) {}

  /// J dev(sigma) = 2 mu J dev(ln V).
  PrincipalStress stress(const Eigen::Vector3d& x, Wanted wanted) const {
    const double two_mu_j = 2 * moduli_.mu * std::exp(x.sum());
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
  /// There is no energy, so this is the work on the straight path of logarithmic strain x s, s from 0 to 1:
  /// the integral of J^s 2 mu s dev(x) : dev(x), N mm/mm³.
  double energy(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d deviator = x.array() - x.mean();
    return 2 * moduli_.mu * deviator.squaredNorm() * ramp_integral(x.sum());
  }
  /// The integral of the pressure kappa ln J over J: kappa (J ln J - J + 1).
  double volume_energy(double dilatation) const {
    const double log = std::log1p(dilatation);
    return moduli_.kappa * log * log * ramp_integral(log);
  }
  ValueAndSlope pressure(double dilatation) const {
    return {moduli_.kappa * std::log1p(dilatation), moduli_.kappa / (1 + dilatation)};
  }
  ValueAndSlope dilatation(double p) const {
    return {std::expm1(p / moduli_.kappa), std::exp(p / moduli_.kappa) / moduli_.kappa};
  }

 private:
  ElasticModuli moduli_;
};

} // namespace springproof::mechanics
