#include "compare/sweep/instructions.hpp"

#include "compare/write.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unistd.h>

namespace compare {

namespace {

namespace fs = std::filesystem;

/// Beside this program; see kernel_calls.cpp for what it takes.
fs::path driver() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "springproof_kernel_calls";
}

constexpr int few_calls = 2, more_calls = 12;

/// Instructions of the driver with so many calls.
double instructions(const std::string& kernel, int cells, int calls, const std::string& instruction_set) {
  const fs::path file = fs::temp_directory_path() / fmt::format("springproof-callgrind-{}.out", ::getpid());
  const std::string command = fmt::format(
      "SPRINGPROOF_INSTRUCTION_SET={} valgrind --tool=callgrind --callgrind-out-file='{}' '{}' {} {} {} "
      ">/dev/null 2>&1",
      instruction_set, file.string(), driver().string(), kernel, cells, calls);
  const int status = std::system(command.c_str());
  std::ifstream counted(file);
  if (status != 0 || !counted) throw std::runtime_error("it failed: " + command);
  const double total = callgrind_total(counted);
  fs::remove(file);
  return total;
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
  if (std::system("command -v valgrind >/dev/null 2>&1") != 0) {
    result.reason = "sweep --perf needs valgrind, which is not installed (apt-get install valgrind)";
    return result;
  }
  const char* asked = std::getenv("SPRINGPROOF_INSTRUCTION_SET");
  result.instruction_set = asked && *asked ? asked : "avx2";
  constexpr int cells = 10;
  const double n_nodes = std::pow(cells + 1., 3);
  try {
    for (const char* kernel : {"force_double", "force_float", "product_double", "product_float",
                               "diagonal_float", "energy_double", "multigrid_cycle", "list_force"}) {
      const double few = instructions(kernel, cells, few_calls, result.instruction_set);
      const double more = instructions(kernel, cells, more_calls, result.instruction_set);
      const double per_call = (more - few) / (more_calls - few_calls);
      result.counts.push_back({kernel, cells, per_call, per_call / n_nodes});
    }
  } catch (const std::exception& error) {
    result.counts.clear();
    result.reason = std::string("sweep --perf: ") + error.what();
  }
  return result;
}

void write_instructions_text(std::ostream& out, const InstructionCounts& counts) {
  fmt::print(out, "instructions of the springs' kernels, {} (callgrind, one thread)\n",
             counts.instruction_set);
  fmt::print(out, "  {:<16} {:>9} {:>14} {:>10}\n", "kernel", "cells", "per call", "per node");
  for (const InstructionCount& c : counts.counts)
    fmt::print(out, "  {:<16} {:>9} {:>14.0f} {:>10.1f}\n", c.kernel, fmt::format("{0}x{0}x{0}", c.cells),
               c.per_call, c.per_node);
}

nlohmann::ordered_json instructions_to_json(const InstructionCounts& counts) {
  nlohmann::ordered_json document = provenance();
  document["instruction_set"] = counts.instruction_set;
  document["kernels"] = nlohmann::ordered_json::array();
  for (const InstructionCount& c : counts.counts)
    document["kernels"].push_back({{"kernel", c.kernel},
                                   {"cells", {c.cells, c.cells, c.cells}},
                                   {"instructions_per_call", c.per_call},
                                   {"instructions_per_node", c.per_node}});
  return document;
}

} // namespace compare
