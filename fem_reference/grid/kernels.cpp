#include "fem_reference/grid/kernels.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace springproof::fem_reference::grid {

namespace baseline {
extern const Kernels the_kernels;
}
namespace avx2 {
extern const Kernels the_kernels;
}
namespace avx512 {
extern const Kernels the_kernels;
}

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

const Kernels& kernels() {
  switch (isa()) {
  case Isa::avx512:
    return avx512::the_kernels;
  case Isa::avx2:
    return avx2::the_kernels;
  case Isa::baseline:
    break;
  }
  return baseline::the_kernels;
}

} // namespace springproof::fem_reference::grid
