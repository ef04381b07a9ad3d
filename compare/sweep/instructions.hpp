#pragma once

#include "compare/table/json.hpp"

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace springproof::compare {

/// Instructions of one call of each kernel, which are the same on every run of the same binary.
struct InstructionCounts {
  std::string instruction_set;                          ///< that of the kernels: valgrind knows no AVX-512
  std::vector<std::pair<std::string, double>> per_call; ///< kernels by name
  std::string reason;                                   ///< why there are none; empty when there are
};

/// Counts the instructions of the springs' kernels with valgrind's callgrind: each runs twice, a few times
/// and a few times more, and the difference is that of the calls alone. The kernels are those that the
/// environment variable SPRINGPROOF_INSTRUCTION_SET names, by default the ones for AVX2.
InstructionCounts count_instructions();

void write_instructions_text(std::ostream& out, const InstructionCounts& counts);
Json instructions_to_json(const InstructionCounts& counts);

/// The total that a callgrind output file ends with: "totals: N" or "summary: N".
/// @throws std::runtime_error when there is none
double callgrind_total(std::istream& in);

} // namespace springproof::compare
