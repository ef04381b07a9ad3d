#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// The divided difference of ln(x)/2, exact also where its arguments, which are > 0, coincide or nearly do.
template<class P>
SPRINGPROOF_INLINE P divided_difference(const P& x, const P& y) {
  constexpr double tiny = sizeof(RealOf<P>) == 8 ? 1e-300 : 1e-36;
  const P t = (x - y) / y, far = absolute(t) > constant<P>(tiny) ? t : constant<P>(1);
  return (absolute(t) > constant<P>(tiny) ? log1p_of(far) / far : constant<P>(1)) / (2 * y);
}

/// Cauchy stress sigma = lambda tr(e) I + 2 mu e, e = ln V: deviator 2 mu dev(e), pressure kappa ln J. Path
/// independent, but no energy belongs to it: its tangent is slightly unsymmetric.
struct LogStrain {
  using Moduli = Full;
  using Material = cases::LinearElastic;
  template<class P>
  SPRINGPROOF_INLINE static void kirchhoff(const P (&x)[3], const Parameters<P>& m, P (&tau)[3]) {
    const P sum = x[0] + x[1] + x[2], two_mu_j = 2 * m.value[0] * exp_of(sum);
    for (int i = 0; i < 3; ++i) tau[i] = two_mu_j * (x[i] - sum / 3);
  }
  template<class P>
  SPRINGPROOF_INLINE static void slopes(const P (&x)[3], const P (&squared)[3], const Parameters<P>& m,
                                        P (&slope)[9], P (&difference)[3]) {
    const P sum = x[0] + x[1] + x[2], two_mu_j = 2 * m.value[0] * exp_of(sum);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        slope[3 * i + j] = two_mu_j * (x[i] - sum / 3 + constant<P>((i == j ? 1. : 0.) - 1. / 3));
    for (int p = 0; p < 3; ++p)
      difference[p] = two_mu_j * divided_difference(squared[(p + 1) % 3], squared[(p + 2) % 3]);
  }
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> pressure(const P& dilatation, const Parameters<P>& m) {
    return {m.value[1] * log1p_of(dilatation), m.value[1] / (1 + dilatation)};
  }
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> dilatation(const P& p, const Parameters<P>& m) {
    const P change = expm1_of(p / m.value[1]);
    return {change, (1 + change) / m.value[1]};
  }
  /// There is no energy, so this is the work on the straight path of logarithmic strain x s, s from 0 to 1:
  /// the integral of J^s 2 mu s dev(x) : dev(x), N mm/mm³.
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&x)[3], const Parameters<P>& m) {
    const P sum = x[0] + x[1] + x[2], a = x[0] - sum / 3, b = x[1] - sum / 3, c = x[2] - sum / 3;
    return 2 * m.value[0] * (a * a + b * b + c * c) * ramp_integral(sum);
  }
  /// The integral of the pressure kappa ln J over J: kappa (J ln J - J + 1).
  template<class P>
  SPRINGPROOF_INLINE static P volume_energy(const P& dilatation, const Parameters<P>& m) {
    const P log = log1p_of(dilatation);
    return m.value[1] * log * log * ramp_integral(log);
  }
};

} // namespace springproof::mechanics
