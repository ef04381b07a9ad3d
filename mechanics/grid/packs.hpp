#pragma once

#include "mechanics/numbers.hpp"

#include <cstddef>
#include <cstdint>
#include <immintrin.h> // intrinsics are always inlined: no shared functions

/// Packs of numbers, for kernels that are compiled once per instruction set. A pack is as many numbers as the
/// set computes at once. What is written for P works on a pack, and on one number in loops that the compiler
/// turns into packs.
namespace springproof::mechanics {

// SPRINGPROOF_MM names the set's intrinsics, the other two glibc's vector functions, good to 4 units in the
// last place.
#if defined(__AVX512F__)
constexpr std::size_t pack_bytes = 64;
#define SPRINGPROOF_MM(name) _mm512_##name
#define SPRINGPROOF_OF_DOUBLES(name) _ZGVeN8v_##name
#define SPRINGPROOF_OF_FLOATS(name) _ZGVeN16v_##name##f
#elif defined(__AVX2__)
constexpr std::size_t pack_bytes = 32;
#define SPRINGPROOF_MM(name) _mm256_##name
#define SPRINGPROOF_OF_DOUBLES(name) _ZGVdN4v_##name
#define SPRINGPROOF_OF_FLOATS(name) _ZGVdN8v_##name##f
#else
constexpr std::size_t pack_bytes = 16;
#define SPRINGPROOF_MM(name) _mm_##name
#define SPRINGPROOF_OF_DOUBLES(name) _ZGVbN2v_##name
#define SPRINGPROOF_OF_FLOATS(name) _ZGVbN4v_##name##f
#endif

namespace {

template<class Real>
struct PackOf {
  typedef Real type __attribute__((vector_size(pack_bytes)));
  typedef Real unaligned __attribute__((vector_size(pack_bytes), aligned(sizeof(Real)), may_alias));
};
template<class Real>
using Pack = typename PackOf<Real>::type;
using PackD = Pack<double>;
using PackF = Pack<float>;
template<class Real>
constexpr int pack_size = static_cast<int>(pack_bytes / sizeof(Real));

} // namespace

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

extern "C" {
PackD SPRINGPROOF_OF_DOUBLES(log1p)(PackD) noexcept;
PackD SPRINGPROOF_OF_DOUBLES(exp)(PackD) noexcept;
PackD SPRINGPROOF_OF_DOUBLES(expm1)(PackD) noexcept;
PackF SPRINGPROOF_OF_FLOATS(log1p)(PackF) noexcept;
PackF SPRINGPROOF_OF_FLOATS(exp)(PackF) noexcept;
PackF SPRINGPROOF_OF_FLOATS(expm1)(PackF) noexcept;
}

namespace {

SPRINGPROOF_INLINE PackD log1p_of(const PackD& x) {
  return SPRINGPROOF_OF_DOUBLES(log1p)(x);
}
SPRINGPROOF_INLINE PackD exp_of(const PackD& x) {
  return SPRINGPROOF_OF_DOUBLES(exp)(x);
}
SPRINGPROOF_INLINE PackD expm1_of(const PackD& x) {
  return SPRINGPROOF_OF_DOUBLES(expm1)(x);
}
SPRINGPROOF_INLINE PackF log1p_of(const PackF& x) {
  return SPRINGPROOF_OF_FLOATS(log1p)(x);
}
SPRINGPROOF_INLINE PackF exp_of(const PackF& x) {
  return SPRINGPROOF_OF_FLOATS(exp)(x);
}
SPRINGPROOF_INLINE PackF expm1_of(const PackF& x) {
  return SPRINGPROOF_OF_FLOATS(expm1)(x);
}
SPRINGPROOF_INLINE PackD root(const PackD& x) {
  return SPRINGPROOF_MM(sqrt_pd)(x);
}
SPRINGPROOF_INLINE PackF root(const PackF& x) {
  return SPRINGPROOF_MM(sqrt_ps)(x);
}
#if defined(__AVX512F__)
SPRINGPROOF_INLINE bool all_greater(const PackD& a, const PackD& b) {
  return _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ) == 0xff;
}
SPRINGPROOF_INLINE bool all_greater(const PackF& a, const PackF& b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ) == 0xffff;
}
#else
SPRINGPROOF_INLINE bool all_greater(const PackD& a, const PackD& b) {
  return SPRINGPROOF_MM(movemask_pd)(reinterpret_cast<PackD>(a > b)) == (1 << pack_size<double>)-1;
}
SPRINGPROOF_INLINE bool all_greater(const PackF& a, const PackF& b) {
  return SPRINGPROOF_MM(movemask_ps)(reinterpret_cast<PackF>(a > b)) == (1 << pack_size<float>)-1;
}
#endif

template<class Real>
SPRINGPROOF_INLINE Pack<Real> load(const Real* from) {
  return *reinterpret_cast<const typename PackOf<Real>::unaligned*>(from);
}
/// Numbers of 16 bits.
SPRINGPROOF_INLINE PackF load(const std::int16_t* from) {
#if defined(__AVX512F__)
  return _mm512_cvtepi32_ps(
      _mm512_cvtepi16_epi32(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))));
#elif defined(__AVX2__)
  return _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from))));
#else // into the upper halves, and down with their signs
  const __m128i bits = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(from));
  return _mm_cvtepi32_ps(_mm_srai_epi32(_mm_unpacklo_epi16(bits, bits), 16));
#endif
}
template<class Real>
SPRINGPROOF_INLINE void store(Real* to, const Pack<Real>& value) {
  *reinterpret_cast<typename PackOf<Real>::unaligned*>(to) = value;
}
template<class Real>
SPRINGPROOF_INLINE void add(Real* to, const Pack<Real>& value) {
  store(to, load(to) + value);
}

typedef float HalfPackF __attribute__((vector_size(pack_bytes / 2)));
/// Loads as many floats as doubles fit a pack.
SPRINGPROOF_INLINE PackD load_wide(const float* from) {
  typedef float Unaligned __attribute__((vector_size(pack_bytes / 2), aligned(4), may_alias));
  return __builtin_convertvector(*reinterpret_cast<const Unaligned*>(from), PackD);
}
SPRINGPROOF_INLINE PackF narrow(const PackD& low, const PackD& high) {
  const HalfPackF a = __builtin_convertvector(low, HalfPackF), b = __builtin_convertvector(high, HalfPackF);
  PackF result;
  for (int l = 0; l < pack_size<double>; ++l) {
    result[l] = a[l];
    result[l + pack_size<double>] = b[l];
  }
  return result;
}

/// The numbers from, from + 1, ... of a and then b.
template<class P>
SPRINGPROOF_INLINE P window(const P& a, const P& b, int from) {
  constexpr int n = sizeof(P) / sizeof(a[0]);
#ifdef __clang__ // the sanitized build, which has no __builtin_shuffle
  P result;
  for (int i = 0; i < n; ++i) result[i] = from + i < n ? a[from + i] : b[from + i - n];
  return result;
#else
  decltype(a < b) places;
  for (int i = 0; i < n; ++i) places[i] = from + i;
  return __builtin_shuffle(a, b, places);
#endif
}
/// The first n numbers of a and the others of b.
template<class P>
SPRINGPROOF_INLINE P first_of(std::ptrdiff_t n, const P& a, const P& b) {
  decltype(a < b) place, end;
  for (int i = 0; i < static_cast<int>(sizeof(P) / sizeof(a[0])); ++i) {
    place[i] = i;
    end[i] = static_cast<decltype(end[0] + 0)>(n);
  }
  return place < end ? a : b;
}

// 1/sqrt(x), x > 0, from the machine's estimate y. The series of 1/sqrt(1 - e) with e = 1 - x y² has as many
// terms 1 + e/2 + 3/8 e² + ... as bring the estimate's 11.4 or 14 bits to the last digit of a double (1e-16)
// or float.
SPRINGPROOF_INLINE PackF inverse_root(const PackF& x) {
#if defined(__AVX512F__)
  const PackF y = _mm512_rsqrt14_ps(x);
#else
  const PackF y = SPRINGPROOF_MM(rsqrt_ps)(x);
#endif
  const PackF e = 1.0f - (x * y) * y;
  return y + (y * e) * (0.5f + 0.375f * e);
}
SPRINGPROOF_INLINE PackD inverse_root(const PackD& x) {
#if defined(__AVX512F__)
  const PackD y = _mm512_rsqrt14_pd(x);
  const PackD e = 1.0 - (x * y) * y;
  return y + (y * e) * (0.5 + e * (0.375 + 0.3125 * e));
#else
#if defined(__AVX2__)
  const PackD y = _mm256_cvtps_pd(_mm_rsqrt_ps(_mm256_cvtpd_ps(x)));
#else
  const PackD y = _mm_cvtps_pd(_mm_rsqrt_ps(_mm_cvtpd_ps(x)));
#endif
  const PackD e = 1.0 - (x * y) * y;
  return y + (y * e) * (0.5 + e * (0.375 + e * (0.3125 + 0.2734375 * e)));
#endif
}
/// The same one at a time, for loops that the compiler turns into packs.
SPRINGPROOF_INLINE double inverse_root(double x) {
  const float estimate = 1.0f / __builtin_sqrtf(static_cast<float>(x));
  const double y = static_cast<double>(estimate);
  const double error = 1 - x * y * y;
  return y + y * error * (0.5 + 0.375 * error);
}
SPRINGPROOF_INLINE float inverse_root(float x) {
  return 1.0f / __builtin_sqrtf(x);
}

template<class P>
using Bits = typename FormatOf<P>::Bits;

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

/// 2^x, to 1e-17 and 1e-7 but for rounding. x is kept within +-1000 and +-120, so that 0 times the
/// result is 0.
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

} // namespace

} // namespace springproof::mechanics
