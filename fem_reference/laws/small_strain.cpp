#include "fem_reference/laws/formulation.hpp"

namespace springproof::fem_reference {

/// Linear elasticity: sigma = 2 mu dev(eps) + kappa tr(eps) I with eps = sym(F - I). The stress does not turn
/// with the body.
Formulation small_strain(const cases::LinearElastic& material) {
  const auto [lambda, mu, kappa] = elastic_moduli(material);
  Matrix9 tangent = Matrix9::Zero(); // 2 mu (sym - 1/3 I x I)
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      tangent(3 * i + j, 3 * i + j) += mu;
      tangent(3 * i + j, 3 * j + i) += mu;
      tangent(4 * i, 4 * j) -= 2 * mu / 3;
    }
  const auto deviatoric = [tangent](const Matrix3& f, Wanted wanted, PointStress& result) {
    result.stress.noalias() = tangent * flatten(f - Matrix3::Identity());
    if (wanted == Wanted::stress_and_tangent) result.tangent = tangent;
  };
  const VolumetricLaw volumetric{[k = kappa](double j) {
                                   return ValueAndSlope{k * (j - 1), k};
                                 },
                                 [k = kappa](double p) {
                                   return ValueAndSlope{1 + p / k, 1 / k};
                                 }};
  return {deviatoric, volumetric, Kinematics::linear, TangentSymmetry::symmetric};
}

} // namespace springproof::fem_reference
