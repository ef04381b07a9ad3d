#pragma once

#include "mechanics/numbers.hpp"

#include <cmath>

namespace springproof::mechanics {

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
