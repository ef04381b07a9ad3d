#include "msm/grid/kernels.hpp"

#include <cstdlib>
#include <string_view>

namespace springproof::msm::grid {

const InstructionSet& instruction_set() {
  static const InstructionSet& set = []() -> const InstructionSet& {
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
               has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                            __builtin_cpu_supports("avx512vl");
    const char* asked = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
    const std::string_view name = asked ? asked : "";
    if (name == "baseline" || !(has_avx2 || has_avx512)) return baseline;
    return has_avx512 && name != "avx2" ? avx512 : avx2;
  }();
  return set;
}

} // namespace springproof::msm::grid
