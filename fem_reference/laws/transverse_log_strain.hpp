#pragma once

#include "fem_reference/laws/log_stretch.hpp"
#include "fem_reference/laws/transverse_elasticity.hpp"
#include "mechanics/ramp_integral.hpp"

namespace springproof::fem_reference {

/// T = C E with E = ln U and C transversely isotropic about the fibre at rest. T is the stress that does work
/// on E, per deformed volume, and where it has U's axes the Cauchy stress turned back with the body:
///   P = J F S,  S = 2 T : dE/dC.
/// With isotropic constants that is LogStrain, sigma = lambda tr(e) I + 2 mu e. As there the stress depends
/// on F alone but has no energy, and the tangent is slightly unsymmetric; P/J would have the energy E : C :
/// E/2 per rest volume (Miehe, Apel & Lambrecht 2002).
class TransverseLogStrain {
 public:
  using Material = cases::TransverselyIsotropic;
  static constexpr LawTraits traits{Kinematics::finite, TangentSymmetry::unsymmetric, Split::pressure};

  explicit TransverseLogStrain(const Material& material) : elasticity_(material) {}

  /// As of LogStrain, the work on the straight path of logarithmic strain E s, s from 0 to 1, along which U
  /// keeps its axes: the integral of J^s s E : C' : E.
  double energy(const Matrix3& h) const {
    const LogStretch log(h);
    const Vector9 strain = flatten(log.axes * log.strains.asDiagonal() * log.axes.transpose());
    return strain.dot(elasticity_.rest() * strain) * mechanics::ramp_integral(log.strains.sum());
  }
  double volume_energy(double dilatation) const {
    const double log = std::log1p(dilatation);
    return elasticity_.kappa() * log * log * mechanics::ramp_integral(log);
  }
  void stress(const Matrix3& h, Wanted wanted, PointStress& result) const {
    const LogStretch log(h);
    const Matrix3 f = Matrix3::Identity() + h;
    const Matrix3& n = log.axes;
    const Vector9 strain = flatten(n * log.strains.asDiagonal() * n.transpose());
    const Vector9 flat = elasticity_.rest() * strain;
    const Matrix3 t = n.transpose() * flat.reshaped<Eigen::RowMajor>(3, 3) * n; // in the axes N from here
    const Matrix3 second = 2 * log.first.cwiseProduct(t), forward = f * n;
    const double j = f.determinant();
    const Matrix3 first = j * forward * second;
    result.stress = flatten(first * n.transpose());
    if (wanted == Wanted::stress) return;

    Matrix9 turn; // row 3*p + q: N_p x N_q
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) turn.row(3 * p + q) = flatten(n.col(p) * n.col(q).transpose()).transpose();
    const Vector9 divided = flatten(log.first);
    const Matrix9 half = turn * elasticity_.rest(); // Eigen holds no product of three without a temporary
    Matrix9 slope = divided.asDiagonal() * (half * turn.transpose()).eval() * divided.asDiagonal();
    slope += log.curvature(t);
    slope *= 4; // dS/dC is twice d(T : dE/dC)/dC, and dC_rs twice the symmetric part of F_kr dF_ks
    const Matrix3 inverse = forward.inverse();
    Matrix9 in_axes;
    for (int i = 0; i < 3; ++i)
      for (int p = 0; p < 3; ++p)
        for (int k = 0; k < 3; ++k)
          for (int r = 0; r < 3; ++r) {
            double sum = i == k ? second(p, r) : 0;
            for (int q = 0; q < 3; ++q)
              for (int s = 0; s < 3; ++s) sum += forward(i, q) * slope(3 * q + p, 3 * s + r) * forward(k, s);
            in_axes(3 * i + p, 3 * k + r) = j * sum + first(i, p) * inverse(r, k);
          }
    for (int i = 0; i < 3; ++i) // dP/dF: the second index of either pair back from the axes N
      for (int k = 0; k < 3; ++k)
        result.tangent.block<3, 3>(3 * i, 3 * k) = n * in_axes.block<3, 3>(3 * i, 3 * k) * n.transpose();
  }
  ValueAndSlope pressure(double dilatation) const {
    return {elasticity_.kappa() * std::log1p(dilatation), elasticity_.kappa() / (1 + dilatation)};
  }
  ValueAndSlope dilatation(double p) const {
    const double y = p / elasticity_.kappa();
    return {std::expm1(y), std::exp(y) / elasticity_.kappa()};
  }

 private:
  TransverseElasticity elasticity_;
};

} // namespace springproof::fem_reference
