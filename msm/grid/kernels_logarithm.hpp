// Part of kernels_source.hpp, in its namespace: logarithm and power, of a pack, or of one number in loops
// that the compiler turns into packs.
#pragma once

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
template<>
struct FormatOf<PackD> {
  using Real = double;
  typedef unsigned long long Bits __attribute__((vector_size(pack_bytes)));
};
template<>
struct FormatOf<PackF> {
  using Real = float;
  typedef unsigned Bits __attribute__((vector_size(pack_bytes)));
};
template<class P>
using Bits = typename FormatOf<P>::Bits;
template<class P>
using RealOf = typename FormatOf<P>::Real;

/// IEEE 754: bits of the mantissa, the exponent's bias, and 2^mantissa.
template<class Real>
constexpr int mantissa = sizeof(Real) == 8 ? 52 : 23;
template<class Real>
constexpr unsigned long long bias = sizeof(Real) == 8 ? 1023 : 127;
template<class Real>
constexpr Real whole = sizeof(Real) == 8 ? Real(4503599627370496.0) : Real(8388608.0);

template<class To, class From>
SPRINGPROOF_INLINE To bits_as(const From& from) {
  return __builtin_bit_cast(To, from);
}
/// n - offset of whole numbers n >= 0 and offset below 2^mantissa.
template<class P>
SPRINGPROOF_INLINE P number(const Bits<P>& n, RealOf<P> offset) {
  using Real = RealOf<P>;
  const P above = bits_as<P>(n | bits_as<Bits<Real>>(whole<Real>));
#if defined(__clang__) // with -ffast-math it would multiply both terms by a factor of the difference
  return __arithmetic_fence(above - (whole<Real> + offset));
#else
  return above - (whole<Real> + offset);
#endif
}

// The nearest whole number. Adding and subtracting 2^mantissa is not safe: -ffast-math draws it to other
// terms, which lose their digits in it, and the vectoriser of GCC 12 drops __builtin_assoc_barrier.
SPRINGPROOF_INLINE double nearest(double x) {
  return __builtin_rint(x);
}
SPRINGPROOF_INLINE float nearest(float x) {
  return __builtin_rintf(x);
}
#if defined(__AVX512F__)
SPRINGPROOF_INLINE PackD nearest(const PackD& x) {
  return _mm512_roundscale_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
SPRINGPROOF_INLINE PackF nearest(const PackF& x) {
  return _mm512_roundscale_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#elif defined(__AVX2__)
SPRINGPROOF_INLINE PackD nearest(const PackD& x) {
  return _mm256_round_pd(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
SPRINGPROOF_INLINE PackF nearest(const PackF& x) {
  return _mm256_round_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
#else
template<class P>
SPRINGPROOF_INLINE P nearest(const P& x) {
  P n = x;
  for (std::size_t i = 0; i < sizeof(P) / sizeof(x[0]); ++i) n[i] = nearest(x[i]);
  return n;
}
#endif

/// c0 + c1 x + c2 x² + ...
template<class P, class Real, int n>
SPRINGPROOF_INLINE P polynomial(const P& x, const Real (&c)[n]) {
  P sum = P{} + c[n - 1];
#pragma GCC unroll 32
  for (int i = n - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

// Coefficients of the next two: interpolation at Chebyshev's points; errors relative.

/// ln(x)/2 for x > 0, to 3e-18 and 2e-7 of itself but for rounding; next to x = 1 too.
template<class P>
SPRINGPROOF_INLINE P half_log(const P& x) {
  using Real = RealOf<P>;
  constexpr int shift = mantissa<Real>;
  constexpr Bits<Real> one = Bits<Real>(bias<Real>) << shift;
  const Bits<Real> root = bits_as<Bits<Real>>(Real(0.70710678118654752));
  const Bits<P> bits = bits_as<Bits<P>>(x);
  // x = 2^(n - bias) m with sqrt(1/2) <= m < sqrt(2)
  const Bits<P> n = (bits - (root - one)) >> shift;
  const P m = bits_as<P>(bits - (n << shift) + one), f = m - Real(1);
  const P of_exponent = number<P>(n, Real(bias<Real>)) * Real(0.34657359027997265);
  if constexpr (sizeof(Real) == 8) { // ln((1 + s)/(1 - s))/2 = s + s³/3 + ..., s <= 0.172
    constexpr double c[] = {1,
                            0.33333333333333826,
                            0.1999999999965117,
                            0.1428571438032084,
                            0.11111098528363024,
                            0.09091815840114664,
                            0.07656264074182095,
                            0.07404855180327638};
    const P s = f / (m + Real(1));
    return of_exponent + s * polynomial(s * s, c);
  } else {
    constexpr float c[] = {0.499999984f,  -0.250001875f,  0.16667303f,   -0.124844535f,
                           0.0995667394f, -0.0863910303f, 0.0806312395f, -0.0494767537f};
    return of_exponent + f * polynomial(f, c);
  }
}

/// 2^x, to 1e-17 and 1e-7 but for rounding. Beyond 2^1000 and 2^120 as there, so that nothing times it is
/// nothing.
template<class P>
SPRINGPROOF_INLINE P power_of_two(const P& wanted) {
  using Real = RealOf<P>;
  constexpr int shift = mantissa<Real>;
  constexpr Real end = sizeof(Real) == 8 ? 1000 : 120;
  const P least = P{} - end, most = P{} + end;
  const P from_below = wanted > least ? wanted : least, x = from_below < most ? from_below : most;
  const P n = nearest(x), r = x - n;                                       // -1/2 to 1/2
  const Bits<P> bits_of_n = bits_as<Bits<P>>(n + Real(1.5) * whole<Real>); // its last ones
  P fraction;
  if constexpr (sizeof(Real) == 8) {
    constexpr double c[] = {1,
                            0.6931471805599453,
                            0.24022650695910158,
                            0.055504108664821625,
                            0.009618129107587256,
                            0.001333355814640647,
                            0.00015403530463724353,
                            1.5252733841556773e-05,
                            1.3215432535912375e-06,
                            1.0178057087733941e-07,
                            7.074194297288521e-09,
                            4.4558179083360645e-10};
    fraction = polynomial(r, c);
  } else {
    constexpr float c[] = {1.00000008f,   0.693147188f,   0.240221075f,
                           0.0555035711f, 0.00967603192f, 0.00133908634f};
    fraction = polynomial(r, c);
  }
  return bits_as<P>(bits_as<Bits<P>>(fraction) + (bits_of_n << shift));
}
