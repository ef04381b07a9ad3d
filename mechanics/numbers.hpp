#pragma once

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
/// False for what is not a number; of packs, in any lane.
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

} // namespace springproof::mechanics
