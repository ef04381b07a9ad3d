#pragma once

#include "mechanics/laws/ogden.hpp"

namespace springproof::mechanics {

/// W = c10 I + c20 I² + c30 I³, I the sum of isochoric squared stretches less 3, and the volume's part.
struct Yeoh : HyperelasticVolume {
  using Moduli = Upper;
  using Material = cases::Yeoh;
  /// Squares of the isochoric stretches less their mean, dW/dI and d²W/dI².
  template<class P>
  struct Isochoric {
    P mean, beyond[3], slope, curvature;
  };
  template<class P>
  SPRINGPROOF_INLINE static Isochoric<P> isochoric(const P (&x)[3], const Parameters<P>& m) {
    Isochoric<P> of{};
    of.mean = (x[0] + x[1] + x[2]) / 3;
    P sum{};
    for (int i = 0; i < 3; ++i) sum += of.beyond[i] = expm1_of(2 * (x[i] - of.mean)); // keeps small strains
    for (int i = 0; i < 3; ++i) of.beyond[i] -= sum / 3;
    of.slope = m.value[1] + sum * (2 * m.value[2] + 3 * sum * m.value[3]);
    of.curvature = 2 * m.value[2] + 6 * sum * m.value[3];
    return of;
  }
  /// tau_i = 2 dW/dI (s_i - (s_1 + s_2 + s_3)/3), s_i = (isochoric stretch i)².
  template<class P>
  SPRINGPROOF_INLINE static void kirchhoff(const P (&x)[3], const Parameters<P>& m, P (&tau)[3]) {
    const Isochoric<P> of = isochoric(x, m);
    for (int i = 0; i < 3; ++i) tau[i] = 2 * of.slope * of.beyond[i];
  }
  template<class P>
  SPRINGPROOF_INLINE static void slopes(const P (&x)[3], const P (&)[3], const Parameters<P>& m,
                                        P (&slope)[9], P (&difference)[3]) {
    const Isochoric<P> of = isochoric(x, m);
    P power[3];
    for (int i = 0; i < 3; ++i) power[i] = exp_of(2 * (x[i] - of.mean));
    const P third = (power[0] + power[1] + power[2]) / 3;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        slope[3 * i + j] =
            4 * of.slope * ((i == j ? power[i] : P{}) - (power[i] + power[j] - third) / 3) +
            4 * of.curvature * of.beyond[i] * of.beyond[j];
    for (int p = 0; p < 3; ++p) difference[p] = 2 * of.slope * exp_of(-2 * of.mean); // s_i = lambda_i²/J^(2/3)
  }
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&x)[3], const Parameters<P>& m) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    P sum{};
    for (int i = 0; i < 3; ++i) sum += exponential_beyond_linear(2 * (x[i] - mean)); // their sum is linear: 0
    return sum * (m.value[1] + sum * (m.value[2] + sum * m.value[3]));
  }
};

} // namespace springproof::mechanics
