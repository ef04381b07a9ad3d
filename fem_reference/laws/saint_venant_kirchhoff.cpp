#include "fem_reference/laws/formulation.hpp"

namespace springproof::fem_reference {

/// S = lambda tr(E) I + 2 mu E with E = (F^T F - I)/2, P = F S, and
/// A_iJkL = delta_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik delta_JL).
Formulation saint_venant_kirchhoff(const cases::LinearElastic& material) {
  const auto [lambda_, mu_, kappa] = elastic_moduli(material);
  const auto law = [lambda = lambda_, mu = mu_](const Matrix3& f, Wanted wanted, PointStress& result) {
    const Matrix3 strain = 0.5 * (f.transpose() * f - Matrix3::Identity());
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
  };
  return {law, std::nullopt, Kinematics::finite, TangentSymmetry::symmetric};
}

} // namespace springproof::fem_reference
