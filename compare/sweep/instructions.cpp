#include "compare/sweep/write_sweep.hpp"

#include "cases/case/installation.hpp"
#include "compare/provenance/call_program.hpp"
#include "compare/write/write.hpp"

#include <cstdlib>
#include <filesystem>
#include <fmt/ostream.h>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>

namespace springproof::compare {

namespace {

namespace fs = std::filesystem;

const char* const kernels[] = {"force_double",   "force_float",   "product_double",  "product_float",
                               "diagonal_float", "energy_double", "multigrid_cycle", "list_force"};
constexpr int cells_of_cube = 10; ///< along each edge
constexpr double nodes_of_cube = (cells_of_cube + 1.) * (cells_of_cube + 1.) * (cells_of_cube + 1.);

/// Instructions of one call of each kernel. One run for all: valgrind takes seconds to start.
/// @return nothing if valgrind is not installed
std::optional<std::vector<double>> instructions(const std::string& instruction_set) {
  const ScratchFolder scratch("callgrind");
  // See kernel_calls.cpp for what the driver takes.
  std::vector<std::string> words{"valgrind",
                                 "--tool=callgrind",
                                 "--collect-atstart=no",
                                 "--toggle-collect=springproof_counted_call",
                                 "--dump-after=springproof_counted_call",
                                 "--callgrind-out-file=out",
                                 cases::private_file("springproof_kernel_calls"),
                                 std::to_string(cells_of_cube)};
  words.insert(words.end(), std::begin(kernels), std::end(kernels));
  const auto end = call_program({words, scratch.path(), {"SPRINGPROOF_INSTRUCTION_SET=" + instruction_set}});
  if (!end) return std::nullopt;
  std::vector<double> totals;
  for (std::size_t n = 1; end->status == 0 && n <= std::size(kernels); ++n) {
    std::ifstream counted(scratch.path() / fmt::format("out.{}", n));
    if (counted) totals.push_back(callgrind_total(counted));
  }
  if (totals.size() != std::size(kernels))
    throw std::runtime_error(fmt::format("{} failed: {}", fmt::join(words, " "), end->said));
  return totals;
}

} // namespace

double callgrind_total(std::istream& in) {
  double total = -1;
  for (std::string line; std::getline(in, line);)
    for (const char* key : {"totals: ", "summary: "})
      if (line.rfind(key, 0) == 0) total = std::stod(line.substr(line.find(' ')));
  if (!(total >= 0)) throw std::runtime_error("callgrind's output has no total");
  return total;
}

InstructionCounts count_instructions() {
  InstructionCounts result;
  const char* asked = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
  result.instruction_set = asked && *asked ? asked : "avx2";
  try {
    const auto counted = instructions(result.instruction_set);
    if (!counted)
      result.reason = "sweep --perf needs valgrind, which is not installed (apt-get install valgrind)";
    for (std::size_t k = 0; counted && k < counted->size(); ++k)
      result.per_call.emplace_back(kernels[k], (*counted)[k]);
  } catch (const std::exception& error) {
    result.reason = std::string("sweep --perf: ") + error.what();
  }
  return result;
}

void write_instructions_text(std::ostream& out, const InstructionCounts& counts) {
  fmt::print(out, "instructions of the springs' kernels, {} (callgrind, one thread)\n",
             counts.instruction_set);
  fmt::print(out, "  {:<16} {:>9} {:>14} {:>10}\n", "kernel", "cells", "per call", "per node");
  for (const auto& [kernel, per_call] : counts.per_call)
    fmt::print(out, "  {:<16} {:>9} {:>14.0f} {:>10.1f}\n", kernel, fmt::format("{0}x{0}x{0}", cells_of_cube),
               per_call, per_call / nodes_of_cube);
}

Json instructions_to_json(const InstructionCounts& counts) {
  Json document = provenance();
  document["instruction_set"] = counts.instruction_set;
  document["kernels"] = Json::array();
  for (const auto& [kernel, per_call] : counts.per_call)
    document["kernels"].push_back({{"kernel", kernel},
                                   {"cells", {cells_of_cube, cells_of_cube, cells_of_cube}},
                                   {"instructions_per_call", per_call},
                                   {"instructions_per_node", per_call / nodes_of_cube}});
  return document;
}

} // namespace springproof::compare
