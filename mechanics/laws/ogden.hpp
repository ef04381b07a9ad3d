#pragma once

#include "mechanics/elastic_moduli.hpp"
#include "mechanics/laws/principal_stress.hpp"
#include "mechanics/ramp_integral.hpp"

namespace springproof::mechanics {

/// Bulk modulus over initial shear modulus of an Ogden material that names none: the volume of the thesis's
/// cube changes by less than 0.1 % under every load, its bar's deflection by 0.02 % from that at twice the
/// ratio.
constexpr double nearly_incompressible_ratio = 1000;

/// W = sum 2 mu/alpha² (isochoric stretches^alpha - 3) + kappa/4 (J² - 1 - 2 ln J), so p = kappa/2 (J - 1/J).
class Ogden {
 public:
  using Material = cases::Ogden;
  static constexpr bool has_energy = true;

  explicit Ogden(const Material& material)
      : material_(material),
        kappa_(material.bulk_modulus.value_or(nearly_incompressible_ratio * shear_modulus(material))) {}

  /// tau_i = sum_p 2 mu_p/alpha_p (s_i - (s_1 + s_2 + s_3)/3), s_i = (isochoric stretch i)^alpha_p.
  PrincipalStress stress(const Eigen::Vector3d& x, Wanted wanted) const {
    const Eigen::Vector3d isochoric = x.array() - x.mean();
    PrincipalStress s{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()};
    for (std::size_t term = 0; term < material_.mu.size(); ++term) {
      const double mu = material_.mu[term], alpha = material_.alpha[term];
      // less 1, so that small strains keep their digits
      const Eigen::Vector3d excess = (alpha * isochoric).unaryExpr([](double y) { return std::expm1(y); });
      s.kirchhoff += 2 * mu / alpha * (excess.array() - excess.mean()).matrix();
      if (wanted == Wanted::stress) continue;
      const Eigen::Vector3d power = excess.array() + 1;
      const double mean = power.mean();
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
  /// sum 2 mu/alpha² (isochoric stretches^alpha - 3), N mm/mm³. Their logarithms add up to 0, so that what is
  /// linear in them may be left out.
  double energy(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d isochoric = x.array() - x.mean();
    double sum = 0;
    for (std::size_t term = 0; term < material_.mu.size(); ++term) {
      const double mu = material_.mu[term], alpha = material_.alpha[term];
      for (int i = 0; i < 3; ++i)
        sum += 2 * mu / (alpha * alpha) * exponential_beyond_linear(alpha * isochoric(i));
    }
    return sum;
  }
  /// kappa/4 (J² - 1 - 2 ln J)
  double volume_energy(double dilatation) const {
    return kappa_ / 4 * exponential_beyond_linear(2 * std::log1p(dilatation));
  }
  ValueAndSlope pressure(double dilatation) const {
    const double j = 1 + dilatation;
    return {kappa_ / 2 * dilatation * (1 + j) / j, kappa_ / 2 * (1 + 1 / (j * j))};
  }
  /// One less than the positive root of J² - 2 p/kappa J - 1 = 0, without cancellation for either sign of p.
  ValueAndSlope dilatation(double p) const {
    const double q = p / kappa_, root = std::sqrt(q * q + 1), beyond = q * q / (root + 1); // root - 1
    const double j = q >= 0 ? q + root : 1 / (root - q);
    return {q >= 0 ? q + beyond : (q - beyond) / (root - q), j / (root * kappa_)};
  }

 private:
  Material material_;
  double kappa_;
};

} // namespace springproof::mechanics
