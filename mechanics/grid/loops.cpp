#include "mechanics/grid/clones.hpp"
#include "mechanics/grid/field.hpp"

namespace springproof::mechanics::grid {

SPRINGPROOF_CLONES void add(double* __restrict a, double factor, const double* __restrict b,
                            std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] += factor * b[i];
}
SPRINGPROOF_CLONES void add(float* __restrict a, float factor, const float* __restrict b, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] += factor * b[i];
}

SPRINGPROOF_CLONES void add_product(double* __restrict a, const double* __restrict b,
                                    const double* __restrict c, std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] += b[i] * c[i];
}
SPRINGPROOF_CLONES void add_product(float* __restrict a, const float* __restrict b, const float* __restrict c,
                                    std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] += b[i] * c[i];
}

SPRINGPROOF_CLONES void scale_and_add(double* __restrict a, double factor, const double* __restrict b,
                                      std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] = b[i] + factor * a[i];
}
SPRINGPROOF_CLONES void scale_and_add(float* __restrict a, float factor, const float* __restrict b,
                                      std::ptrdiff_t n) {
  for (std::ptrdiff_t i = 0; i < n; ++i) a[i] = b[i] + factor * a[i];
}

SPRINGPROOF_CLONES double dot(const double* __restrict a, const double* __restrict b, std::ptrdiff_t n) {
  constexpr int lanes = 16; // sums of their own: packs of any width add the same way
  double sum[lanes] = {};
  std::ptrdiff_t i = 0;
  for (; i + lanes <= n; i += lanes)
    for (int lane = 0; lane < lanes; ++lane) sum[lane] += a[i + lane] * b[i + lane];
  for (int lane = 0; i < n; ++i, ++lane) sum[lane] += a[i] * b[i];
  for (int half = lanes / 2; half > 0; half /= 2)
    for (int lane = 0; lane < half; ++lane) sum[lane] += sum[lane + half];
  return sum[0];
}

SPRINGPROOF_CLONES void apply_blocks(const float* __restrict block, const float* __restrict in,
                                     float* __restrict out, std::ptrdiff_t size, float keep, float factor,
                                     std::ptrdiff_t n) {
  const float *x = in, *y = in + size, *z = y + size;
  float *u = out, *v = out + size, *w = v + size;
#pragma GCC ivdep
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const float xx = block[i], yy = block[i + size], zz = block[i + 2 * size], yz = block[i + 3 * size],
                xz = block[i + 4 * size], xy = block[i + 5 * size];
    u[i] = keep * u[i] + factor * (xx * x[i] + xy * y[i] + xz * z[i]);
    v[i] = keep * v[i] + factor * (xy * x[i] + yy * y[i] + yz * z[i]);
    w[i] = keep * w[i] + factor * (xz * x[i] + yz * y[i] + zz * z[i]);
  }
}

} // namespace springproof::mechanics::grid
