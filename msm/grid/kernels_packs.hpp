// Part of kernels_source.hpp, in its namespace: packs of numbers, vectors of them and rows of a field.
#pragma once

// A pack is as many numbers as the instruction set computes at once.
#if defined(__AVX512F__)
constexpr std::size_t pack_bytes = 64;
#elif defined(__AVX2__)
constexpr std::size_t pack_bytes = 32;
#else
constexpr std::size_t pack_bytes = 16;
#endif

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
constexpr std::ptrdiff_t pack_size = pack_bytes / sizeof(Real);

template<class Real>
SPRINGPROOF_INLINE Pack<Real> load(const Real* from) {
  return *reinterpret_cast<const typename PackOf<Real>::unaligned*>(from);
}
template<class Real>
SPRINGPROOF_INLINE void store(Real* to, const Pack<Real>& value) {
  *reinterpret_cast<typename PackOf<Real>::unaligned*>(to) = value;
}

/// The numbers from, from + 1, ... of a and then b.
template<class P>
SPRINGPROOF_INLINE P window(const P& a, const P& b, int from) {
  constexpr int n = sizeof(P) / sizeof(a[0]);
#ifdef __clang__ // of the sanitized build; it has no __builtin_shuffle
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
  SPRINGPROOF_INLINE Real& operator[](int c) { return c == 0 ? x : c == 1 ? y : z; }
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
template<class P>
SPRINGPROOF_INLINE Vec<P> window(const Vec<P>& a, const Vec<P>& b, int from) {
  return {window(a.x, b.x, from), window(a.y, b.y, from), window(a.z, b.z, from)};
}

/// Three arrays of one row.
template<class Real>
struct Rows {
  const Real *x, *y, *z;
  SPRINGPROOF_INLINE Vec<Real> at(std::ptrdiff_t i) const { return {x[i], y[i], z[i]}; }
};
template<class Real>
SPRINGPROOF_INLINE Rows<Real> rows(const Real* field, std::ptrdiff_t array, std::ptrdiff_t offset) {
  return {field + offset, field + array + offset, field + 2 * array + offset};
}

/// First node of plane k of a result's array c: in the field, or in the spill.
template<class Real>
SPRINGPROOF_INLINE Real* result_plane(const Layout& layout, const Slab<Real>& slab, Real* field, int k,
                                      int c) {
  return k < slab.last ? field + layout.at(0, 0, k, c) : slab.spill + c * layout.plane + layout.at(0, 0, -1);
}
