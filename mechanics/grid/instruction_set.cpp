#include "mechanics/grid/instruction_set.hpp"

#include <cstdlib>
#include <string_view>

namespace springproof::mechanics::grid {

InstructionSet instruction_set() {
  static const InstructionSet found = [] {
    const bool has_avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"),
               has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                            __builtin_cpu_supports("avx512vl");
    const char* asked = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
    const std::string_view name = asked ? asked : "";
    if (name == "baseline" || !(has_avx2 || has_avx512)) return InstructionSet::baseline;
    return has_avx512 && name != "avx2" ? InstructionSet::avx512 : InstructionSet::avx2;
  }();
  return found;
}

const char* name_of(InstructionSet set) {
  return set == InstructionSet::avx512 ? "avx512" : set == InstructionSet::avx2 ? "avx2" : "baseline";
}

} // namespace springproof::mechanics::grid
