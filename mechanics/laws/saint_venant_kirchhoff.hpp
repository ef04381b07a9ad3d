#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// S = lambda tr(E) I + 2 mu E with E = (F^T F - I)/2, P = F S, and
/// A_iJkL = delta_ik S_JL + lambda F_iJ F_kL + mu (F_iL F_kJ + (F F^T)_ik delta_JL).
struct SaintVenantKirchhoff {
  static constexpr bool is_finite = true, has_pressure = false;
  using Moduli = Upper;
  using Material = cases::LinearElastic;
  template<class P>
  SPRINGPROOF_INLINE static void second(const P (&h)[9], const Parameters<P>& m, P (&s)[9]) {
    const P lambda = m.value[1] - m.value[0] * 2 / 3;
    P c[6];
    twice_green_strain(h, c);
    const P pressure = lambda * ((c[0] + c[1] + c[2]) / 2);
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, d = (a + 2) % 3;
      s[4 * a] = m.value[0] * c[a] + pressure;
      s[3 * b + d] = s[3 * d + b] = m.value[0] * c[3 + a];
    }
  }
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    P s[9];
    second(h, m, s);
    first_stress(h, s, stress);
  }
  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&h)[9], const Parameters<P>& m, P (&moduli)[Upper::n]) {
    const P mu = m.value[0], lambda = m.value[1] - m.value[0] * 2 / 3;
    P s[9], f[9], left[9];
    second(h, m, s);
    deformation_gradient(h, f);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k)
        left[3 * i + k] = f[3 * i] * f[3 * k] + f[3 * i + 1] * f[3 * k + 1] + f[3 * i + 2] * f[3 * k + 2];
    for (int i = 0; i < 3; ++i)
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k)
          for (int b = 0; b < 3; ++b) {
            const int r = 3 * i + a, t = 3 * k + b;
            if (r > t) continue;
            P value = lambda * f[r] * f[t] + mu * f[3 * i + b] * f[3 * k + a];
            if (i == k) value += s[3 * a + b];
            if (a == b) value += mu * left[3 * i + k];
            moduli[Upper::at(r, t)] = value;
          }
  }
  /// lambda/2 tr(E)² + mu E : E
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&h)[9], const Parameters<P>& m) {
    P c[6];
    twice_green_strain(h, c);
    const P sum = c[0] + c[1] + c[2],
            squared = c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + 2 * (c[3] * c[3] + c[4] * c[4] + c[5] * c[5]);
    return (m.value[1] / 2 - m.value[0] / 3) * sum * sum / 4 + m.value[0] * squared / 4;
  }
};

} // namespace springproof::mechanics
