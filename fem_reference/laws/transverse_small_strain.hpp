#pragma once

#include "fem_reference/laws/transverse_elasticity.hpp"

namespace springproof::fem_reference {

/// sigma = C eps with eps = sym(H) and C transversely isotropic. Neither the stress nor the fibre turns
/// with the body.
class TransverseSmallStrain {
 public:
  using Material = cases::TransverselyIsotropic;
  static constexpr LawTraits traits{Kinematics::linear, TangentSymmetry::symmetric, Split::pressure};

  explicit TransverseSmallStrain(const Material& material) : elasticity_(material) {}

  double energy(const Matrix3& h) const {
    const Vector9 gradient = flatten(h);
    return 0.5 * gradient.dot(elasticity_.rest() * gradient);
  }
  double volume_energy(double dilatation) const { return elasticity_.kappa() / 2 * dilatation * dilatation; }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    result.stress.noalias() = elasticity_.rest() * flatten(h);
    if (wanted == Wanted::stress_and_tangent) result.tangent = elasticity_.rest();
  }
  ValueAndSlope pressure(double dilatation) const {
    return {elasticity_.kappa() * dilatation, elasticity_.kappa()};
  }
  ValueAndSlope dilatation(double p) const { return {p / elasticity_.kappa(), 1 / elasticity_.kappa()}; }

 private:
  TransverseElasticity elasticity_;
};

} // namespace springproof::fem_reference
