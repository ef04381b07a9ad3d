#pragma once

#include "fem_reference/laws/point.hpp"
#include "mechanics/elastic_moduli.hpp"

namespace springproof::fem_reference {

/// Linear elasticity: sigma = 2 mu dev(eps) + kappa tr(eps) I with eps = sym(H). The stress does not turn
/// with the body.
class SmallStrain {
 public:
  using Material = cases::LinearElastic;
  static constexpr LawTraits traits{Kinematics::linear, TangentSymmetry::symmetric, Split::pressure};

  explicit SmallStrain(const Material& material) {
    const auto moduli = mechanics::elastic_moduli(material);
    kappa_ = moduli.kappa;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        tangent_(3 * i + j, 3 * i + j) += moduli.mu;
        tangent_(3 * i + j, 3 * j + i) += moduli.mu;
        tangent_(4 * i, 4 * j) -= 2 * moduli.mu / 3;
      }
  }
  double energy(const Matrix3& h) const {
    const Vector9 gradient = flatten(h);
    return 0.5 * gradient.dot(tangent_ * gradient);
  }
  double volume_energy(double dilatation) const { return kappa_ / 2 * dilatation * dilatation; }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    result.stress.noalias() = tangent_ * flatten(h);
    if (wanted == Wanted::stress_and_tangent) result.tangent = tangent_;
  }
  ValueAndSlope pressure(double dilatation) const { return {kappa_ * dilatation, kappa_}; }
  ValueAndSlope dilatation(double p) const { return {p / kappa_, 1 / kappa_}; }

 private:
  Matrix9 tangent_ = Matrix9::Zero(); ///< 2 mu (sym - 1/3 I x I)
  double kappa_;
};

} // namespace springproof::fem_reference
