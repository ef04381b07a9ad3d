#pragma once

#include "cases/case/spring_law.hpp"
#include "mechanics/numbers.hpp"

/// Laws of springs and of volume terms, written once for one number and for packs of them: Real is the number
/// that a law's constants are of, P that or a pack. A spring's law is how its tension T follows its stretch
/// q = |d|/l0; it is a type with
///   transverse(|d|², k)      T/|d|,
///   tangent<clamp>(|d|², k)  the second derivative of the energy with respect to d,
///   twice_energy(|d|², k)    N mm, and
///   Volume                   the law of the volume terms beside such springs.
/// Functions come from Math: Exact is for one number, the kernels have faster ones.
namespace springproof::msm {

/// The laws of springs that there are. A law may have a parameter for each spring: power_log's exponent.
using LawKind = cases::SpringLaw;

/// Whether what is negative in a tangent is left out: the transverse stiffness of a compressed spring, and
/// the other one where a power-log spring has passed its largest tension.
enum class Clamp { no, yes };

/// A spring's tangent, transverse I + along d d^T.
template<class P>
struct SpringTangent {
  P transverse, along;
};

template<class P>
SPRINGPROOF_INLINE P not_negative(const P& x) {
  return x > P{} ? x : P{};
}

/// Pressure k (V - V0), tension-positive, k = k_v/V0.
template<class Real>
struct LinearVolume {
  static constexpr bool is_logarithmic = false;
  Real rest_volume;
  SPRINGPROOF_INLINE Real pressure(Real volume, Real k) const { return k * (volume - rest_volume); }
  template<Clamp>
  SPRINGPROOF_INLINE Real slope(Real, Real k) const {
    return k;
  }
  template<class P>
  SPRINGPROOF_INLINE P twice_energy(const P& volume, const P& k) const {
    const P change = volume - rest_volume;
    return k * change * change;
  }
};

/// Pressure k V0 ln J, J = V/V0: no number at J <= 0, so that no state with such a cell is accepted.
template<class Real, class Math>
struct LogarithmicVolume {
  static constexpr bool is_logarithmic = true;
  Real rest_volume, inverse_rest_volume = 1 / rest_volume;
  template<class P>
  SPRINGPROOF_INLINE P log_volume(const P& volume, const P& k) const {
    return Math::log_volume(P(volume * inverse_rest_volume), k);
  }
  SPRINGPROOF_INLINE Real pressure(Real volume, Real k) const {
    return k * rest_volume * log_volume(volume, k);
  }
  /// Clamped, of a J of 0.1 at least: coarse cells may be inverted where fine ones are not.
  template<Clamp clamp>
  SPRINGPROOF_INLINE Real slope(Real volume, Real k) const {
    const Real least = clamp == Clamp::yes ? Real(0.1) : Real(1e-30), ratio = volume * inverse_rest_volume;
    return k / (ratio > least ? ratio : least);
  }
  template<class P>
  SPRINGPROOF_INLINE P twice_energy(const P& volume, const P& k) const {
    const P log = log_volume(volume, k);
    return Real(2) * k * rest_volume * rest_volume * log * log *
           mechanics::ramp_integral(log, Math::exponential(P(Real(Math::of_exponential) * log)));
  }
};

/// T = k (|d| - l0), and linear volume terms. k < 0 is a property of the lattice and stays when clamped.
template<class Real, class Math>
struct Hooke {
  using Volume = LinearVolume<Real>;
  static constexpr const char* parameter = nullptr; ///< its name, if there is one
  Real rest_length;

  Hooke() = default;
  SPRINGPROOF_INLINE Hooke(Real rest, Real) : rest_length(rest) {}
  template<class P>
  SPRINGPROOF_INLINE P transverse(const P& squared, const P& k) const {
    return Math::elongation_share(k, rest_length, squared);
  }
  template<Clamp clamp, class P>
  SPRINGPROOF_INLINE SpringTangent<P> tangent(const P& squared, const P& k) const {
    const P exact = transverse(squared, k), t = clamp == Clamp::yes ? not_negative(exact) : exact;
    return {t, Math::over_squared(k - t, squared)};
  }
  template<class P>
  SPRINGPROOF_INLINE P twice_energy(const P& squared, const P& k) const {
    const P elongation = Math::length(squared) - rest_length;
    return k * elongation * elongation;
  }
};

/// T = k l0 q^p ln q, and logarithmic volume terms: of the same stiffness k at rest as Hooke's, and of the
/// second derivative (2p - 1) k/l0 there, so that the exponent p decides whether it stiffens or softens.
template<class Real, class Math>
struct PowerLog {
  using Volume = LogarithmicVolume<Real, Math>;
  static constexpr const char* parameter = "exponent";
  Real rest_length, inverse_rest_squared, exponent;
  Real force_rate, tangent_rate; ///< p - 1 and p - 3, for Math's exponential

  PowerLog() = default;
  SPRINGPROOF_INLINE PowerLog(Real rest, Real p)
      : rest_length(rest), inverse_rest_squared(1 / (rest * rest)), exponent(p),
        force_rate(Real(Math::of_exponential) * (p - 1)), tangent_rate(Real(Math::of_exponential) * (p - 3)) {
  }
  template<class P>
  SPRINGPROOF_INLINE P log_stretch(const P& squared) const {
    return Math::log_stretch(squared, rest_length, inverse_rest_squared);
  }
  /// k q^(p-1) ln q
  template<class P>
  SPRINGPROOF_INLINE P transverse(const P& squared, const P& k) const {
    const P log = log_stretch(squared);
    return k * Math::exponential(force_rate * log) * log;
  }
  /// k q^(p-1) (ln q I + (1 + p ln q - ln q) d d^T/|d|²); clamped, ln q and 1 + p ln q are at least 0.
  template<Clamp clamp, class P>
  SPRINGPROOF_INLINE SpringTangent<P> tangent(const P& squared, const P& k) const {
    const P log = log_stretch(squared);
    const P power = k * inverse_rest_squared * Math::exponential(tangent_rate * log);
    P transverse = log, along = exponent * log + Real(1);
    if constexpr (clamp == Clamp::yes) {
      transverse = not_negative(transverse);
      along = not_negative(along);
    }
    return {power * squared * transverse, power * (along - transverse)};
  }
  /// 2 k l0² times the integral of q^p ln q from 1.
  template<class P>
  SPRINGPROOF_INLINE P twice_energy(const P& squared, const P& k) const {
    const P log = log_stretch(squared), x = (exponent + Real(1)) * log;
    return Real(2) * k / inverse_rest_squared * log * log *
           mechanics::ramp_integral(x, Math::exponential(Real(Math::of_exponential) * x));
  }
};

/// A type as a value.
template<class Law>
struct LawType {
  using type = Law;
};

/// action(LawType<law>)
template<class Real, class Math, class Action>
SPRINGPROOF_INLINE auto with_law(LawKind kind, const Action& action) {
#pragma GCC diagnostic error "-Wswitch" // a law that is forgotten here must not compile
  switch (kind) {
  case LawKind::power_log:
    return action(LawType<PowerLog<Real, Math>>{});
  case LawKind::hooke:
    break;
  }
  return action(LawType<Hooke<Real, Math>>{});
}

} // namespace springproof::msm
