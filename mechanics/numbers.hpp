#pragma once

#include <cmath>

/// What laws are written with, for one number; mechanics/grid/packs.hpp has the same for packs of numbers. A
/// law includes nothing that defines functions others share, since kernels are compiled for instructions that
/// the machine may lack: all is inlined.
#define SPRINGPROOF_INLINE inline __attribute__((always_inline))

namespace springproof::mechanics {

/// The numbers that P, a pack or one number, is made of, and whole numbers of the same size.
template<class P>
struct FormatOf;
template<>
struct FormatOf<double> {
  using Real = double;
  using Bits = unsigned long long;
};
template<>
struct FormatOf<float> {
  using Real = float;
  using Bits = unsigned;
};
template<class P>
using RealOf = typename FormatOf<P>::Real;

SPRINGPROOF_INLINE double log1p_of(double x) {
  return __builtin_log1p(x);
}
SPRINGPROOF_INLINE double exp_of(double x) {
  return __builtin_exp(x);
}
SPRINGPROOF_INLINE double expm1_of(double x) {
  return __builtin_expm1(x);
}
SPRINGPROOF_INLINE double root(double x) {
  return __builtin_sqrt(x);
}
/// Whether a > b, in packs for every lane; false where one is not a number.
SPRINGPROOF_INLINE bool all_greater(double a, double b) {
  return a > b;
}

template<class P>
SPRINGPROOF_INLINE P constant(double value) {
  return P{} + static_cast<RealOf<P>>(value);
}
template<class P>
SPRINGPROOF_INLINE P absolute(const P& x) {
  return x < P{} ? -x : x;
}
template<class P>
SPRINGPROOF_INLINE P larger(const P& a, const P& b) {
  return a > b ? a : b;
}

/// 1/(n! (n + 2))
template<class Real>
constexpr Real ramp_coefficient(int n) {
  Real factorial = 1;
  for (int i = 2; i <= n; ++i) factorial *= Real(i);
  return 1 / (factorial * Real(n + 2));
}

/// The integral of s e^(x s) over s from 0 to 1:  (e^x (x - 1) + 1)/x², and 1/2 at x = 0. Energies of
/// logarithmic laws are made of it: that of a spring, of a volume, and the work along a straight path of
/// logarithmic strain.
/// @param exponential  e^x
template<class P>
SPRINGPROOF_INLINE P ramp_integral(const P& x, const P& exponential) {
  using Real = RealOf<P>;
  const P one = P{} + Real(1), squared = x * x;
  const P closed = (exponential * (x - one) + one) / squared;
  const P from_below = x > -one ? x : -one, inside = from_below < one ? from_below : one;
  P series = P{}; // there the difference has no digits left
#pragma GCC unroll 32
  for (int n = sizeof(Real) == 8 ? 18 : 9; n >= 0; --n) series = series * inside + ramp_coefficient<Real>(n);
  return squared < one ? series : closed;
}
inline double ramp_integral(double x) {
  return ramp_integral(x, std::exp(x));
}

/// e^y - 1 - y = y² e^y ramp_integral(-y), with its leading digits where y is small.
inline double exponential_beyond_linear(double y) {
  return y * y * std::exp(y) * ramp_integral(-y);
}

} // namespace springproof::mechanics
