// Part of kernels_source.hpp, in its namespace: what Hooke's and the power-log law make of springs and cells.
// What is written for P works on a pack, and on one number in loops that the compiler turns into packs.
#pragma once

/// A spring's tangent: transverse I + along d d^T.
template<class P>
struct Slopes {
  P transverse, along;
};

/// 1/|d|. A ghost may lie where a node is: hence the 1e-30.
template<class Real>
SPRINGPROOF_INLINE Real inverse_length(Real squared) {
  return inverse_root(squared > Real(1e-30) ? squared : Real(1e-30));
}

/// Hooke's springs and linear volume terms. Springs are known by their place among the 13, cells by k_v/V0.
template<class Real>
struct Hooke {
  const Springs<Real>& s;

  /// t I + (k - t) d d^T/|d|² with t = k (1 - l0/|d|), at least 0 when clamped.
  template<Clamp clamp>
  SPRINGPROOF_INLINE Slopes<Real> slopes(Real length_squared, Real k, int spring) const {
    const Real least = clamp == Clamp::yes ? Real(0) : Real(-1e30), inverse = inverse_length(length_squared);
    Real t = k * (Real(1) - s.rest_length[spring] * inverse);
    t = t > least * k ? t : least * k;
    return {t, (k - t) * inverse * inverse};
  }
  SPRINGPROOF_INLINE Real twice_energy(Real length_squared, Real k, int spring) const {
    const Real elongation = length_squared * inverse_length(length_squared) - s.rest_length[spring];
    return k * elongation * elongation;
  }
  SPRINGPROOF_INLINE Real pressure(Real volume, Real k) const { return k * (volume - s.rest_volume); }
  /// Derivative of the pressure with respect to the volume.
  template<Clamp>
  SPRINGPROOF_INLINE Real volume_slope(Real, Real k) const {
    return k;
  }
  SPRINGPROOF_INLINE Real twice_volume_energy(Real volume, Real k) const {
    const Real change = volume - s.rest_volume;
    return k * change * change;
  }
};

/// 1/(n! (n + 2))
template<class Real>
constexpr Real power_log_coefficient(int n) {
  Real factorial = 1;
  for (int i = 2; i <= n; ++i) factorial *= Real(i);
  return 1 / (factorial * Real(n + 2));
}

/// (e^x (x - 1) + 1)/x², and 1/2 at x = 0. Times ln²q, x = (p + 1) ln q, the integral of q^p ln q from 1.
template<class P>
SPRINGPROOF_INLINE P power_log_ratio(const P& x) {
  using Real = RealOf<P>;
  const P one = P{} + Real(1), squared = x * x;
  const P closed = (power_of_two(Real(1.4426950408889634) * x) * (x - one) + one) / squared;
  const P from_below = x > -one ? x : -one, inside = from_below < one ? from_below : one;
  P series = P{}; // there the difference has no digits left
#pragma GCC unroll 32
  for (int n = sizeof(Real) == 8 ? 18 : 9; n >= 0; --n)
    series = series * inside + power_log_coefficient<Real>(n);
  return squared < one ? series : closed;
}

/// Power-log springs and logarithmic volume terms, known as Hooke's.
template<class Real>
struct PowerLog {
  Real inverse_rest_squared[n_springs]; ///< 1/l0²
  Real exponent[n_springs];             ///< p
  Real force_rate[n_springs];           ///< (p - 1)/ln 2
  Real tangent_rate[n_springs];         ///< (p - 3)/ln 2
  Real rest_volume, inverse_rest_volume;

  SPRINGPROOF_INLINE explicit PowerLog(const Springs<Real>& s)
      : rest_volume(s.rest_volume), inverse_rest_volume(1 / s.rest_volume) {
    constexpr Real to_two = Real(1.4426950408889634);
    for (int i = 0; i < n_springs; ++i) {
      inverse_rest_squared[i] = 1 / (s.rest_length[i] * s.rest_length[i]);
      exponent[i] = s.exponent[i];
      force_rate[i] = to_two * (s.exponent[i] - 1);
      tangent_rate[i] = to_two * (s.exponent[i] - 3);
    }
  }

  /// ln q. A ghost may lie where a node is: hence the 1e-30.
  template<class P>
  SPRINGPROOF_INLINE P log_stretch(const P& length_squared, int spring) const {
    return half_log(length_squared * inverse_rest_squared[spring] + Real(1e-30));
  }
  /// Tension over length, k q^(p-1) ln q.
  template<class P>
  SPRINGPROOF_INLINE P transverse(const P& length_squared, const P& k, int spring) const {
    const P log = log_stretch(length_squared, spring);
    return k * log * power_of_two(force_rate[spring] * log);
  }
  /// k q^(p-1) (ln q I + (1 + p ln q - ln q) d d^T/|d|²); clamped, ln q and 1 + p ln q are at least 0.
  template<Clamp clamp, class P>
  SPRINGPROOF_INLINE Slopes<P> slopes(const P& length_squared, const P& k, int spring) const {
    const P log = log_stretch(length_squared, spring);
    const P power = k * inverse_rest_squared[spring] * power_of_two(tangent_rate[spring] * log);
    P transverse = log, along = exponent[spring] * log + Real(1);
    if constexpr (clamp == Clamp::yes) {
      transverse = transverse > Real(0) ? transverse : P{};
      along = along > Real(0) ? along : P{};
    }
    return {power * length_squared * transverse, power * (along - transverse)};
  }
  template<class P>
  SPRINGPROOF_INLINE P twice_energy(const P& length_squared, const P& k, int spring) const {
    const P log = log_stretch(length_squared, spring);
    return Real(2) * k / inverse_rest_squared[spring] * log * log *
           power_log_ratio((exponent[spring] + Real(1)) * log);
  }

  /// ln J; no number where J <= 0, by its bits, since -ffast-math knows no such thing. Where there is no
  /// cell, J is anything, and k is 0.
  SPRINGPROOF_INLINE Real log_volume(Real volume, Real k) const {
    const Real ratio = volume * inverse_rest_volume;
    const Bits<Real> none = ratio > Real(0) || k == Real(0) ? Bits<Real>(0) : ~Bits<Real>(0);
    return bits_as<Real>(bits_as<Bits<Real>>(Real(2) * half_log(ratio)) | none);
  }
  SPRINGPROOF_INLINE Real pressure(Real volume, Real k) const {
    return k * rest_volume * log_volume(volume, k);
  }
  /// Clamped, of a J of 0.1 at least: coarse cells may be inverted where fine ones are not.
  template<Clamp clamp>
  SPRINGPROOF_INLINE Real volume_slope(Real volume, Real k) const {
    const Real least = clamp == Clamp::yes ? Real(0.1) : Real(1e-30), ratio = volume * inverse_rest_volume;
    return k / (ratio > least ? ratio : least);
  }
  SPRINGPROOF_INLINE Real twice_volume_energy(Real volume, Real k) const {
    const Real log = log_volume(volume, k);
    return Real(2) * k * rest_volume * rest_volume * log * log * power_log_ratio(log);
  }
};
