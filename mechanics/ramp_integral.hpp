#pragma once

#include <cmath>

namespace springproof::mechanics {

/// The integral of s e^(x s) over s from 0 to 1:  (e^x (x - 1) + 1)/x², and 1/2 at x = 0. Energies of
/// logarithmic laws are made of it: that of a spring, of a volume, and the work along a straight path of
/// logarithmic strain.
inline double ramp_integral(double x) {
  if (!(std::abs(x) < 1)) return (std::exp(x) * (x - 1) + 1) / (x * x);
  double sum = 0.5, term = 0.5; // x^n (n + 1)/(n + 2)!: there the difference has no digits left
  for (int n = 1; n <= 18; ++n) {
    term *= x / (n + 2);
    sum += (n + 1) * term;
  }
  return sum;
}

/// e^y - 1 - y = y² e^y ramp_integral(-y), with its leading digits where y is small.
inline double exponential_beyond_linear(double y) {
  return y * y * std::exp(y) * ramp_integral(-y);
}

} // namespace springproof::mechanics
