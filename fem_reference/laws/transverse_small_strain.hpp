#pragma once

#include "fem_reference/laws/point.hpp"
#include "mechanics/elastic_moduli.hpp"

namespace springproof::fem_reference {

/// The elasticity tensor of a transversely isotropic material, C = C' + kappa 1 x 1. Averaged elements
/// average the second part alone. kappa = 1/(1 : C^-1 : 1) is the largest for which C' has no negative
/// eigenvalue: C' stores no energy in the strain of a body under pressure from all sides, and stays bounded
/// when kappa does not. In an isotropic material C' is 2 mu times the deviator and kappa the bulk modulus.
/// Source of the split: Felippa & Onate 2003, Comput Struct 81:1343.
class TransverseElasticity {
 public:
  explicit TransverseElasticity(const cases::TransverselyIsotropic& material) {
    const mechanics::TransverseModuli c = mechanics::transverse_moduli(material);
    kappa_ = c.bulk_modulus;
    // Spencer's form with A = a x a, a the fibre: stress = lambda tr(e) 1 + 2 mu_T e
    // + alpha ((a.ea) 1 + tr(e) A) + 2 (mu_L - mu_T)(A e + e A) + beta (a.ea) A
    const double alpha = c.c13 - c.c12, difference = c.c44 - c.c66;
    const double beta = c.c33 - c.c12 - 2 * c.c66 - 2 * alpha - 4 * difference;
    const Matrix3 one = Matrix3::Identity(), fibre = material.fibre * material.fibre.transpose();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k)
          for (int l = 0; l < 3; ++l)
            rest_(3 * i + j, 3 * k + l) = (c.c12 - kappa_) * one(i, j) * one(k, l) +
                                          c.c66 * (one(i, k) * one(j, l) + one(i, l) * one(j, k)) +
                                          alpha * (one(i, j) * fibre(k, l) + fibre(i, j) * one(k, l)) +
                                          difference * (fibre(i, k) * one(j, l) + fibre(i, l) * one(j, k) +
                                                        one(i, k) * fibre(j, l) + one(i, l) * fibre(j, k)) +
                                          beta * fibre(i, j) * fibre(k, l);
  }

  const Matrix9& rest() const { return rest_; } ///< C', MPa
  double kappa() const { return kappa_; }       ///< MPa

 private:
  Matrix9 rest_;
  double kappa_;
};

/// What transversely isotropic laws share: the pressure is that of an isotropic law with their kappa.
template<class Isotropic>
class TransverseLaw {
 public:
  using Material = cases::TransverselyIsotropic;
  explicit TransverseLaw(const Material& material)
      : elasticity_(material), parameters_{{0, elasticity_.kappa()}, 2} {}

  double volume_energy(double dilatation) const { return Isotropic::volume_energy(dilatation, parameters_); }
  ValueAndSlope pressure(double dilatation) const { return Isotropic::pressure(dilatation, parameters_); }
  ValueAndSlope dilatation(double p) const { return Isotropic::dilatation(p, parameters_); }

 protected:
  TransverseElasticity elasticity_;

 private:
  mechanics::Parameters<double> parameters_;
};

/// sigma = C eps with eps = sym(H) and C transversely isotropic. Neither the stress nor the fibre turns
/// with the body.
class TransverseSmallStrain : public TransverseLaw<mechanics::SmallStrain> {
 public:
  static constexpr LawTraits traits{Kinematics::linear, TangentSymmetry::symmetric, Split::pressure};
  using TransverseLaw::TransverseLaw;

  double energy(const Matrix3& h) const {
    const Vector9 gradient = flatten(h);
    return 0.5 * gradient.dot(elasticity_.rest() * gradient);
  }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    result.stress.noalias() = elasticity_.rest() * flatten(h);
    if (wanted == Wanted::stress_and_tangent) result.tangent = elasticity_.rest();
  }
};

} // namespace springproof::fem_reference
