// Part of kernels_source.hpp, in its namespace: packs of numbers.
#pragma once

// A pack is as many numbers as the instruction set computes at once.
#if defined(__AVX512F__)
#define SPRINGPROOF_PACK_BYTES 64
#elif defined(__AVX2__)
#define SPRINGPROOF_PACK_BYTES 32
#else
#define SPRINGPROOF_PACK_BYTES 16
#endif

typedef double PackD __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
typedef double LooseD __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(8), may_alias));
typedef float PackF __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
typedef float LooseF __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(4), may_alias));
typedef float HalfPackF __attribute__((vector_size(SPRINGPROOF_PACK_BYTES / 2)));
typedef float LooseHalfF __attribute__((vector_size(SPRINGPROOF_PACK_BYTES / 2), aligned(4), may_alias));

template<class P>
struct RealOf;
template<>
struct RealOf<PackD> {
  using type = double;
};
template<>
struct RealOf<PackF> {
  using type = float;
};
template<class P>
constexpr int lanes = static_cast<int>(SPRINGPROOF_PACK_BYTES / sizeof(typename RealOf<P>::type));

/// A number that is a type.
template<int n>
struct Count {
  static constexpr int value = n;
};

SPRINGPROOF_INLINE PackD load(const double* from) {
  return *reinterpret_cast<const LooseD*>(from);
}
SPRINGPROOF_INLINE PackF load(const float* from) {
  return *reinterpret_cast<const LooseF*>(from);
}
/// As many floats as doubles fit a pack.
SPRINGPROOF_INLINE PackD load_wide(const float* from) {
  return __builtin_convertvector(*reinterpret_cast<const LooseHalfF*>(from), PackD);
}
SPRINGPROOF_INLINE PackF narrow(const PackD& low, const PackD& high) {
  const HalfPackF a = __builtin_convertvector(low, HalfPackF), b = __builtin_convertvector(high, HalfPackF);
  PackF result;
  for (int l = 0; l < lanes<PackD>; ++l) {
    result[l] = a[l];
    result[l + lanes<PackD>] = b[l];
  }
  return result;
}
SPRINGPROOF_INLINE void store(double* to, const PackD& value) {
  *reinterpret_cast<LooseD*>(to) = value;
}
SPRINGPROOF_INLINE void store(float* to, const PackF& value) {
  *reinterpret_cast<LooseF*>(to) = value;
}
SPRINGPROOF_INLINE void add(double* to, const PackD& value) {
  store(to, load(to) + value);
}
SPRINGPROOF_INLINE void add(float* to, const PackF& value) {
  store(to, load(to) + value);
}

// glibc's vector functions, to 4 units in the last place.
#if defined(__AVX512F__)
extern "C" {
__m512d _ZGVeN8v_log1p(__m512d) noexcept;
__m512d _ZGVeN8v_exp(__m512d) noexcept;
__m512d _ZGVeN8v_expm1(__m512d) noexcept;
__m512 _ZGVeN16v_log1pf(__m512) noexcept;
__m512 _ZGVeN16v_expf(__m512) noexcept;
__m512 _ZGVeN16v_expm1f(__m512) noexcept;
}
SPRINGPROOF_INLINE PackD log1p_of(const PackD& x) {
  return _ZGVeN8v_log1p(x);
}
SPRINGPROOF_INLINE PackD exp_of(const PackD& x) {
  return _ZGVeN8v_exp(x);
}
SPRINGPROOF_INLINE PackD expm1_of(const PackD& x) {
  return _ZGVeN8v_expm1(x);
}
SPRINGPROOF_INLINE PackF log1p_of(const PackF& x) {
  return _ZGVeN16v_log1pf(x);
}
SPRINGPROOF_INLINE PackF exp_of(const PackF& x) {
  return _ZGVeN16v_expf(x);
}
SPRINGPROOF_INLINE PackF expm1_of(const PackF& x) {
  return _ZGVeN16v_expm1f(x);
}
SPRINGPROOF_INLINE PackD root(const PackD& x) {
  return _mm512_sqrt_pd(x);
}
SPRINGPROOF_INLINE PackF root(const PackF& x) {
  return _mm512_sqrt_ps(x);
}
/// False for lanes that are not a number.
SPRINGPROOF_INLINE bool all_greater(const PackD& a, const PackD& b) {
  return _mm512_cmp_pd_mask(a, b, _CMP_GT_OQ) == 0xff;
}
SPRINGPROOF_INLINE bool all_greater(const PackF& a, const PackF& b) {
  return _mm512_cmp_ps_mask(a, b, _CMP_GT_OQ) == 0xffff;
}
#elif defined(__AVX2__)
extern "C" {
__m256d _ZGVdN4v_log1p(__m256d) noexcept;
__m256d _ZGVdN4v_exp(__m256d) noexcept;
__m256d _ZGVdN4v_expm1(__m256d) noexcept;
__m256 _ZGVdN8v_log1pf(__m256) noexcept;
__m256 _ZGVdN8v_expf(__m256) noexcept;
__m256 _ZGVdN8v_expm1f(__m256) noexcept;
}
SPRINGPROOF_INLINE PackD log1p_of(const PackD& x) {
  return _ZGVdN4v_log1p(x);
}
SPRINGPROOF_INLINE PackD exp_of(const PackD& x) {
  return _ZGVdN4v_exp(x);
}
SPRINGPROOF_INLINE PackD expm1_of(const PackD& x) {
  return _ZGVdN4v_expm1(x);
}
SPRINGPROOF_INLINE PackF log1p_of(const PackF& x) {
  return _ZGVdN8v_log1pf(x);
}
SPRINGPROOF_INLINE PackF exp_of(const PackF& x) {
  return _ZGVdN8v_expf(x);
}
SPRINGPROOF_INLINE PackF expm1_of(const PackF& x) {
  return _ZGVdN8v_expm1f(x);
}
SPRINGPROOF_INLINE PackD root(const PackD& x) {
  return _mm256_sqrt_pd(x);
}
SPRINGPROOF_INLINE PackF root(const PackF& x) {
  return _mm256_sqrt_ps(x);
}
SPRINGPROOF_INLINE bool all_greater(const PackD& a, const PackD& b) {
  return _mm256_movemask_pd(_mm256_cmp_pd(a, b, _CMP_GT_OQ)) == 0xf;
}
SPRINGPROOF_INLINE bool all_greater(const PackF& a, const PackF& b) {
  return _mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_GT_OQ)) == 0xff;
}
#else
extern "C" {
__m128d _ZGVbN2v_log1p(__m128d) noexcept;
__m128d _ZGVbN2v_exp(__m128d) noexcept;
__m128d _ZGVbN2v_expm1(__m128d) noexcept;
__m128 _ZGVbN4v_log1pf(__m128) noexcept;
__m128 _ZGVbN4v_expf(__m128) noexcept;
__m128 _ZGVbN4v_expm1f(__m128) noexcept;
}
SPRINGPROOF_INLINE PackD log1p_of(const PackD& x) {
  return _ZGVbN2v_log1p(x);
}
SPRINGPROOF_INLINE PackD exp_of(const PackD& x) {
  return _ZGVbN2v_exp(x);
}
SPRINGPROOF_INLINE PackD expm1_of(const PackD& x) {
  return _ZGVbN2v_expm1(x);
}
SPRINGPROOF_INLINE PackF log1p_of(const PackF& x) {
  return _ZGVbN4v_log1pf(x);
}
SPRINGPROOF_INLINE PackF exp_of(const PackF& x) {
  return _ZGVbN4v_expf(x);
}
SPRINGPROOF_INLINE PackF expm1_of(const PackF& x) {
  return _ZGVbN4v_expm1f(x);
}
SPRINGPROOF_INLINE PackD root(const PackD& x) {
  return _mm_sqrt_pd(x);
}
SPRINGPROOF_INLINE PackF root(const PackF& x) {
  return _mm_sqrt_ps(x);
}
SPRINGPROOF_INLINE bool all_greater(const PackD& a, const PackD& b) {
  return _mm_movemask_pd(_mm_cmpgt_pd(a, b)) == 0x3;
}
SPRINGPROOF_INLINE bool all_greater(const PackF& a, const PackF& b) {
  return _mm_movemask_ps(_mm_cmpgt_ps(a, b)) == 0xf;
}
#endif

template<class P>
SPRINGPROOF_INLINE P constant(double value) {
  return P{} + static_cast<typename RealOf<P>::type>(value);
}
template<class P>
SPRINGPROOF_INLINE P absolute(const P& x) {
  return x < P{} ? -x : x;
}
template<class P>
SPRINGPROOF_INLINE P larger(const P& a, const P& b) {
  return a > b ? a : b;
}
