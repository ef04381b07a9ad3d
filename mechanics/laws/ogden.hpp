#pragma once

#include "mechanics/laws/point.hpp"

namespace springproof::mechanics {

/// sinh(a d)/sinh(d), to rounding error for every d; a at d = 0.
template<class P>
SPRINGPROOF_INLINE P sinh_ratio(const P& a, const P& d) {
  const P near = constant<P>(sizeof(RealOf<P>) == 8 ? 1e-3 : 0.01);
  const P far = absolute(d) > near ? d : constant<P>(1);
  const P above = exp_of(a * far), below = exp_of(far);
  const P direct = (above - 1 / above) / (below - 1 / below);
  // a (1 + (a²-1) d²/6 + (a²-1)(3a²-7) d⁴/360): the next term is below 1e-17 a⁶ for d < 1e-3
  const P square = d * d, excess = a * a - 1;
  const P series = a * (1 + excess * square / 6 * (1 + (3 * a * a - 7) * square / 60));
  return absolute(d) > near ? direct : series;
}

/// kappa/4 (J² - 1 - 2 ln J), so p = kappa/2 (J - 1/J): the volume's part of hyperelastic laws.
struct HyperelasticVolume {
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> pressure(const P& dilatation, const Parameters<P>& m) {
    const P j = 1 + dilatation;
    return {m.value[0] / 2 * dilatation * (1 + j) / j, m.value[0] / 2 * (1 + 1 / (j * j))};
  }
  /// One less than the positive root of J² - 2 p/kappa J - 1 = 0, without cancellation for either sign of p.
  template<class P>
  SPRINGPROOF_INLINE static ValueAndSlope<P> dilatation(const P& p, const Parameters<P>& m) {
    const P q = p / m.value[0], length = root(q * q + 1), beyond = q * q / (length + 1);
    const P j = q >= P{} ? q + length : 1 / (length - q);
    return {q >= P{} ? q + beyond : (q - beyond) / (length - q), j / (length * m.value[0])};
  }
  /// kappa/4 (J² - 1 - 2 ln J)
  template<class P>
  SPRINGPROOF_INLINE static P volume_energy(const P& dilatation, const Parameters<P>& m) {
    return m.value[0] / 4 * exponential_beyond_linear(2 * log1p_of(dilatation));
  }
};

/// W = sum 2 mu/alpha² (isochoric stretches^alpha - 3), and the volume's part.
struct Ogden : HyperelasticVolume {
  using Moduli = Upper;
  using Material = cases::Ogden;
  /// tau_i = sum_p 2 mu_p/alpha_p (s_i - (s_1 + s_2 + s_3)/3), s_i = (isochoric stretch i)^alpha_p.
  template<class P>
  SPRINGPROOF_INLINE static void kirchhoff(const P (&x)[3], const Parameters<P>& m, P (&tau)[3]) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    for (int i = 0; i < 3; ++i) tau[i] = P{};
    for (int t = 1; t < m.n; t += 2) {
      const P mu = m.value[t], alpha = m.value[t + 1];
      P excess[3]; // powers less 1, so that small strains keep their digits
      for (int i = 0; i < 3; ++i) excess[i] = expm1_of(alpha * (x[i] - mean));
      const P third = (excess[0] + excess[1] + excess[2]) / 3;
      for (int i = 0; i < 3; ++i) tau[i] += 2 * mu / alpha * (excess[i] - third);
    }
  }
  template<class P>
  SPRINGPROOF_INLINE static void slopes(const P (&x)[3], const P (&)[3], const Parameters<P>& m,
                                        P (&slope)[9], P (&difference)[3]) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    for (int e = 0; e < 9; ++e) slope[e] = P{};
    for (int p = 0; p < 3; ++p) difference[p] = P{};
    for (int t = 1; t < m.n; t += 2) {
      const P mu = m.value[t], alpha = m.value[t + 1];
      P power[3];
      for (int i = 0; i < 3; ++i) power[i] = exp_of(alpha * (x[i] - mean));
      const P third = (power[0] + power[1] + power[2]) / 3;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          slope[3 * i + j] += 2 * mu * ((i == j ? power[i] : P{}) - (power[i] + power[j] - third) / 3);
      for (int p = 0; p < 3; ++p) {
        const int i = (p + 1) % 3, j = (p + 2) % 3;
        // e^(alpha a) - e^(alpha b) over e^2a' - e^2b' with isochoric a, b and true a', b'; a - b = a' - b'
        const P centre = alpha * ((x[i] + x[j]) / 2 - mean) - (x[i] + x[j]);
        difference[p] += 2 * mu / alpha * exp_of(centre) * sinh_ratio(alpha / 2, x[i] - x[j]);
      }
    }
  }
  /// sum 2 mu/alpha² (isochoric stretches^alpha - 3), N mm/mm³. Their logarithms add up to 0, so that what is
  /// linear in them may be left out.
  template<class P>
  SPRINGPROOF_INLINE static P energy(const P (&x)[3], const Parameters<P>& m) {
    const P mean = (x[0] + x[1] + x[2]) / 3;
    P sum{};
    for (int t = 1; t < m.n; t += 2)
      for (int i = 0; i < 3; ++i)
        sum += 2 * m.value[t] / (m.value[t + 1] * m.value[t + 1]) *
               exponential_beyond_linear(m.value[t + 1] * (x[i] - mean));
    return sum;
  }
};

} // namespace springproof::mechanics
