#include "msm/grid/kernels.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace springproof::msm::grid {

namespace baseline {
extern const Kernels<double> double_kernels;
extern const Kernels<float> float_kernels;
} // namespace baseline
namespace avx2 {
extern const Kernels<double> double_kernels;
extern const Kernels<float> float_kernels;
} // namespace avx2
namespace avx512 {
extern const Kernels<double> double_kernels;
extern const Kernels<float> float_kernels;
} // namespace avx512

namespace {

enum class Isa { baseline, avx2, avx512 };

Isa widest() {
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
      __builtin_cpu_supports("avx512vl"))
    return Isa::avx512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return Isa::avx2;
  return Isa::baseline;
}

Isa isa() {
  static const Isa found = [] {
    const char* asked = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
    const std::string_view name = asked ? asked : "";
    if (name == "baseline") return Isa::baseline;
    if (name == "avx2") return std::min(Isa::avx2, widest());
    return widest();
  }();
  return found;
}

} // namespace

template<>
const Kernels<double>& kernels() {
  switch (isa()) {
  case Isa::avx512:
    return avx512::double_kernels;
  case Isa::avx2:
    return avx2::double_kernels;
  default:
    return baseline::double_kernels;
  }
}

template<>
const Kernels<float>& kernels() {
  switch (isa()) {
  case Isa::avx512:
    return avx512::float_kernels;
  case Isa::avx2:
    return avx2::float_kernels;
  default:
    return baseline::float_kernels;
  }
}

const char* instruction_set() {
  switch (isa()) {
  case Isa::avx512:
    return "avx512";
  case Isa::avx2:
    return "avx2";
  default:
    return "baseline";
  }
}

} // namespace springproof::msm::grid
