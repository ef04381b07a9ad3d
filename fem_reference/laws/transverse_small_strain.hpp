#pragma once

#include "fem_reference/laws/transverse_elasticity.hpp"

namespace springproof::fem_reference {

/// sigma = C eps with eps = sym(F - I) and C transversely isotropic. Neither the stress nor the fibre turns
/// with the body.
class TransverseSmallStrain {
 public:
  using Material = cases::TransverselyIsotropic;
  static constexpr LawTraits traits{Kinematics::linear, TangentSymmetry::symmetric, Split::pressure};

  explicit TransverseSmallStrain(const Material& material) : elasticity_(material) {}

  double energy(const Matrix3& f) const {
    const Vector9 gradient = flatten(f - Matrix3::Identity());
    return 0.5 * gradient.dot(elasticity_.rest() * gradient);
  }
  double volume_energy(double j) const { return elasticity_.kappa() / 2 * (j - 1) * (j - 1); }
  void stress(const Matrix3& f, Wanted wanted, PointStress& result) const {
    result.stress.noalias() = elasticity_.rest() * flatten(f - Matrix3::Identity());
    if (wanted == Wanted::stress_and_tangent) result.tangent = elasticity_.rest();
  }
  ValueAndSlope pressure(double j) const { return {elasticity_.kappa() * (j - 1), elasticity_.kappa()}; }
  ValueAndSlope volume_ratio(double p) const {
    return {1 + p / elasticity_.kappa(), 1 / elasticity_.kappa()};
  }

 private:
  TransverseElasticity elasticity_;
};

} // namespace springproof::fem_reference
