// Part of kernels_source.hpp, in its namespace: packs of numbers, vectors of them and rows of a field.
#pragma once

// A pack is as many numbers as the instruction set computes at once.
#if defined(__AVX512F__)
#define SPRINGPROOF_PACK_BYTES 64
#elif defined(__AVX2__)
#define SPRINGPROOF_PACK_BYTES 32
#else
#define SPRINGPROOF_PACK_BYTES 16
#endif

template<class Real>
struct PackOf;
template<>
struct PackOf<double> {
  typedef double type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
  typedef double unaligned __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(8), may_alias));
};
template<>
struct PackOf<float> {
  typedef float type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
  typedef float unaligned __attribute__((vector_size(SPRINGPROOF_PACK_BYTES), aligned(4), may_alias));
};
/// Whole numbers that choose those of two packs.
template<std::size_t bytes>
struct MaskOf;
template<>
struct MaskOf<8> {
  typedef long long type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
};
template<>
struct MaskOf<4> {
  typedef int type __attribute__((vector_size(SPRINGPROOF_PACK_BYTES)));
};
template<class Real>
using Pack = typename PackOf<Real>::type;
using PackD = Pack<double>;
using PackF = Pack<float>;

template<class Real>
constexpr std::ptrdiff_t pack_size = SPRINGPROOF_PACK_BYTES / sizeof(Real);

SPRINGPROOF_INLINE PackD load(const double* from) {
  return *reinterpret_cast<const PackOf<double>::unaligned*>(from);
}
SPRINGPROOF_INLINE PackF load(const float* from) {
  return *reinterpret_cast<const PackOf<float>::unaligned*>(from);
}
SPRINGPROOF_INLINE void store(double* to, const PackD& value) {
  *reinterpret_cast<PackOf<double>::unaligned*>(to) = value;
}
SPRINGPROOF_INLINE void store(float* to, const PackF& value) {
  *reinterpret_cast<PackOf<float>::unaligned*>(to) = value;
}

// 1/sqrt(x), x > 0, from the machine's estimate: of 1/sqrt(1 - e) with e = 1 - x y², as many terms of the
// series 1 + e/2 + 3/8 e² + ... as bring the estimate's 11.4 or 14 bits to the last digit of a double (1e-16)
// or float.
SPRINGPROOF_INLINE PackF inverse_root(const PackF& x) {
#if defined(__AVX512F__)
  const PackF y = _mm512_rsqrt14_ps(x);
#elif defined(__AVX2__)
  const PackF y = _mm256_rsqrt_ps(x);
#else
  const PackF y = _mm_rsqrt_ps(x);
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

template<class Real>
struct Vec {
  Real x, y, z;
};
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator+(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator-(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> operator*(Real s, const Vec<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template<class Real>
SPRINGPROOF_INLINE Real dot(const Vec<Real>& a, const Vec<Real>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template<class Real>
SPRINGPROOF_INLINE Vec<Real> cross(const Vec<Real>& a, const Vec<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template<class T>
struct Unqualified {
  using type = T;
};
template<class T>
struct Unqualified<const T> {
  using type = T;
};

/// Three arrays of one row.
template<class Real>
struct Rows {
  using Value = typename Unqualified<Real>::type;
  Real *x, *y, *z;
  SPRINGPROOF_INLINE Vec<Value> at(std::ptrdiff_t i) const { return {x[i], y[i], z[i]}; }
  SPRINGPROOF_INLINE void set(std::ptrdiff_t i, const Vec<Value>& v) const {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};
template<class Real>
SPRINGPROOF_INLINE Rows<Real> rows(Real* field, std::ptrdiff_t array, std::ptrdiff_t offset) {
  return {field + offset, field + array + offset, field + 2 * array + offset};
}
