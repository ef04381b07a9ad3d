#pragma once

#include "fem_reference/laws/point.hpp"
#include "mechanics/elastic_moduli.hpp"

namespace springproof::fem_reference {

/// S = lambda tr(E) I + 2 mu E with E = (F^T F - I)/2, P = F S, and
/// A_iJkL = delta_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik delta_JL).
class SaintVenantKirchhoff {
 public:
  using Material = cases::LinearElastic;
  static constexpr LawTraits traits{Kinematics::finite, TangentSymmetry::symmetric, Split::none};

  explicit SaintVenantKirchhoff(const Material& material) : moduli_(mechanics::elastic_moduli(material)) {}

  /// lambda/2 tr(E)² + mu E : E
  double energy(const Matrix3& h) const {
    const Matrix3 strain = 0.5 * twice_green_strain(h);
    return moduli_.lambda / 2 * strain.trace() * strain.trace() + moduli_.mu * strain.squaredNorm();
  }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    const auto [lambda, mu, kappa] = moduli_;
    const Matrix3 strain = 0.5 * twice_green_strain(h), f = Matrix3::Identity() + h;
    const Matrix3 second = lambda * strain.trace() * Matrix3::Identity() + 2 * mu * strain;
    result.stress = flatten(f * second);
    if (wanted == Wanted::stress) return;
    const Matrix3 left = f * f.transpose();
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k)
          for (int b = 0; b < 3; ++b)
            result.tangent(3 * i + a, 3 * k + b) = (i == k ? second(a, b) : 0) + lambda * f(i, a) * f(k, b) +
                                                   mu * (f(i, b) * f(k, a) + (a == b ? left(i, k) : 0));
  }

 private:
  mechanics::ElasticModuli moduli_;
};

} // namespace springproof::fem_reference
