#pragma once

/// The choice among kernels that springproof_kernels() of cmake/kernels.cmake compiles once per instruction
/// set.
namespace springproof::mechanics::grid {

enum class InstructionSet { baseline, avx2, avx512 };

/// The widest set that this machine has, or a narrower one that the environment variable
/// SPRINGPROOF_INSTRUCTION_SET names ("baseline", "avx2").
InstructionSet instruction_set();
const char* name_of(InstructionSet set);

template<class Table>
const Table& of_this_machine(const Table& baseline, const Table& avx2, const Table& avx512) {
  const InstructionSet set = instruction_set();
  return set == InstructionSet::avx512 ? avx512 : set == InstructionSet::avx2 ? avx2 : baseline;
}

} // namespace springproof::mechanics::grid

/// Declares the tables of kernels of one source, `SPRINGPROOF_ISA::kernels`, and `function()`, which is the
/// one for this machine.
#define SPRINGPROOF_KERNEL_SETS(Table, function)                                                             \
  namespace baseline {                                                                                       \
  extern const Table kernels;                                                                                \
  }                                                                                                          \
  namespace avx2 {                                                                                           \
  extern const Table kernels;                                                                                \
  }                                                                                                          \
  namespace avx512 {                                                                                         \
  extern const Table kernels;                                                                                \
  }                                                                                                          \
  inline const Table& function() {                                                                           \
    return mechanics::grid::of_this_machine(baseline::kernels, avx2::kernels, avx512::kernels);              \
  }
