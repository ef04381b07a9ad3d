#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// W = mu/2 (|F|² - 3) + lambda'/2 (J - 1 - mu/lambda')² less its value at rest, lambda' = lambda + mu, which
/// has Hooke's moduli at rest; P = mu F + (lambda' (J - 1) - mu) cof F. It stays finite where J <= 0.
/// Source: Smith, de Goes and Kim, ACM Trans. Graph. 37 (2018), without their logarithm; Macklin and Mueller,
/// MIG 2021, eq. 8 to 11.
struct NeoHookean {
  static constexpr bool is_finite = true, has_pressure = false;
  using Moduli = Upper;
  using Material = cases::LinearElastic;

  /// lambda', MPa
  template<class P>
  SPRINGPROOF_INLINE static P volume_modulus(const Parameters<P>& m) {
    return m.value[1] + m.value[0] / 3;
  }
  /// mu (F - cof F) + lambda' (J - 1) cof F, with F - cof F = H + H^T - tr(H) I - cof H.
  template<class P>
  SPRINGPROOF_INLINE static void stress(const P (&h)[9], const Parameters<P>& m, P (&stress)[9]) {
    P f[9], area[9], of_h[9];
    deformation_gradient(h, f);
    cofactor(f, area);
    cofactor(h, of_h);
    const P trace = h[0] + h[4] + h[8], pressure = volume_modulus(m) * growth_of(h);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int e = 3 * i + j;
        P sheared = h[e] + h[3 * j + i] - of_h[e];
        if (i == j) sheared -= trace;
        stress[e] = m.value[0] * sheared + pressure * area[e];
      }
  }
  template<class P>
  SPRINGPROOF_INLINE static void moduli(const P (&h)[9], const Parameters<P>& m, P (&moduli)[Upper::n]) {
    P f[9], area[9];
    deformation_gradient(h, f);
    cofactor(f, area);
    const P lambda = volume_modulus(m);
    for (int r = 0; r < 9; ++r)
      for (int s = r; s < 9; ++s) {
        moduli[Upper::at(r, s)] = lambda * area[r] * area[s];
        if (r == s) moduli[Upper::at(r, s)] += m.value[0];
      }
    add_cofactor_derivative<Upper>(f, lambda * growth_of(h) - m.value[0], moduli);
  }
  /// mu (|H|²/2 - I2(H) - det H) + lambda'/2 (J - 1)², whose parts of first order cancel.
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&h)[9], const Parameters<P>& m) {
    P of_h[9], squared{};
    cofactor(h, of_h);
    for (int e = 0; e < 9; ++e) squared += h[e] * h[e];
    const P growth = growth_of(h);
    return m.value[0] * (squared / 2 - (of_h[0] + of_h[4] + of_h[8]) - determinant(h)) +
           volume_modulus(m) * growth * growth / 2;
  }
};

} // namespace springproof::mechanics
