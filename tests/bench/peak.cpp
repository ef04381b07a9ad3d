#include "tests/bench/peak.hpp"

#include <algorithm>
#include <chrono>

using namespace springproof;

namespace {

constexpr int n_steps = 200000;

// Sixteen of the widest registers. target_clones does not go with templates.
__attribute__((target_clones("avx512f", "arch=haswell", "default"))) void chain(double* values) {
  double a[128];
  for (int l = 0; l < 128; ++l) a[l] = values[l];
  for (int i = 0; i < n_steps; ++i)
    for (int l = 0; l < 128; ++l) a[l] = a[l] * 0.999 + 0.001;
  for (int l = 0; l < 128; ++l) values[l] = a[l];
}
__attribute__((target_clones("avx512f", "arch=haswell", "default"))) void chain(float* values) {
  float a[256];
  for (int l = 0; l < 256; ++l) a[l] = values[l];
  for (int i = 0; i < n_steps; ++i)
    for (int l = 0; l < 256; ++l) a[l] = a[l] * 0.999f + 0.001f;
  for (int l = 0; l < 256; ++l) values[l] = a[l];
}

template<class Real>
double measure() {
  constexpr int lanes = 1024 / sizeof(Real);
  Real values[lanes] = {};
  double best = 0;
  for (int run = 0; run < 10; ++run) {
    const auto start = std::chrono::steady_clock::now();
    chain(values);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::max(best, 2.0 * lanes * n_steps / elapsed.count());
  }
  return best;
}

} // namespace

template<class Real>
double peak_flops() {
  static const double found = measure<Real>();
  return found;
}

template double peak_flops<double>();
template double peak_flops<float>();
