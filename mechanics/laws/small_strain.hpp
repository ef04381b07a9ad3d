#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// Linear elasticity: sigma = 2 mu dev(eps) + kappa tr(eps) I with eps = sym(H). The stress does not turn
/// with the body.
struct SmallStrain {
  static constexpr bool is_finite = false, has_pressure = true;
  using Moduli = Upper;
  using Material = cases::LinearElastic;
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    const P mean = (h[0] + h[4] + h[8]) / 3;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        stress[3 * i + j] = m.value[0] * (h[3 * i + j] + h[3 * j + i] - (i == j ? 2 * mean : P{}));
  }
  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&)[9], const Parameters<P>& m, P (&moduli)[Upper::n]) {
    for (int e = 0; e < Upper::n; ++e) moduli[e] = P{};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        moduli[Upper::at(3 * i + j, 3 * i + j)] += m.value[0];
        if (i <= j) moduli[Upper::at(3 * i + j, 3 * j + i)] += m.value[0];
        if (i <= j) moduli[Upper::at(4 * i, 4 * j)] -= m.value[0] * 2 / 3;
      }
  }
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> pressure(const P& dilatation, const Parameters<P>& m) {
    return {m.value[1] * dilatation, m.value[1]};
  }
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> dilatation(const P& p, const Parameters<P>& m) {
    return {p / m.value[1], 1 / m.value[1]};
  }
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&h)[9], const Parameters<P>& m) {
    P twice{}, s[9];
    stress(h, m, s);
    for (int e = 0; e < 9; ++e) twice += s[e] * h[e];
    return twice / 2;
  }
  template<class P>
  SPRINGPROOF_INLINE static P volume_energy(const P& dilatation, const Parameters<P>& m) {
    return m.value[1] / 2 * dilatation * dilatation;
  }
};

} // namespace springproof::mechanics
