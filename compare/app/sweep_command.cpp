#include "cases/case/read_case.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/sweep/instructions.hpp"
#include "compare/sweep/write_sweep.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace springproof::compare {

namespace {

struct SweepOptions {
  std::string file, out;
  bool json = false, quick = false, perf = false;
};

/// What is finished is on disk before the next variant starts.
void show(const Sweep& sweep, const std::string& folder) {
  if (!folder.empty())
    write_file(folder + "/sweep.csv", [&](std::ostream& out) { write_sweep_csv(out, sweep); });
  if (isatty(STDERR_FILENO))
    std::cerr << fmt::format("\r{:<100}{}",
                             fmt::format("{} of {}: {}", sweep.rows.size(), sweep.plan.variants.size(),
                                         full_name(sweep.rows.back().variant)),
                             sweep.rows.size() == sweep.plan.variants.size() ? "\n" : "");
}

void write_files(const std::string& folder, const Sweep& sweep) {
  write_file(folder + "/sweep.txt", [&](std::ostream& out) { write_sweep_text(out, sweep); });
  write_file(folder + "/sweep.json", [&](std::ostream& out) { out << sweep_to_json(sweep).dump(2) << '\n'; });
  plot_sweep(folder, sweep);
}

int sweep(const SweepOptions& options) {
  const bool speaks = mpi_rank() == 0;
  const cases::Case definition = cases::read_case(options.file);
  claim_folder(options.out);
  const TimingRules rules = options.quick ? TimingRules{5, 0.1} : TimingRules{};
  const Sweep result = run_sweep(definition, options.quick ? Extent::quick : Extent::full, rules,
                                 "/proc/self/exe", [&](const Sweep& so_far) {
                                   if (speaks) show(so_far, options.out);
                                 });
  const bool failed =
      !result.reference || std::any_of(result.rows.begin(), result.rows.end(), [](const SweepRow& row) {
        return row.run.first.status == cases::Status::failed;
      });
  if (!speaks) return failed;
  if (options.json)
    std::cout << sweep_to_json(result).dump(2) << '\n';
  else
    write_sweep_text(std::cout, result);
  if (!options.out.empty()) write_files(options.out, result);
  return failed;
}

int count(const SweepOptions& options) {
  if (mpi_rank() != 0) return 0;
  const InstructionCounts counts = count_instructions();
  if (!counts.reason.empty()) {
    std::cerr << counts.reason << '\n';
    return 2;
  }
  if (options.json)
    std::cout << instructions_to_json(counts).dump(2) << '\n';
  else
    write_instructions_text(std::cout, counts);
  return 0;
}

int run(const SweepOptions& options) {
  if (options.perf) return count(options);
  if (options.file.empty()) throw cases::InputError("sweep: a case file is needed, or --perf");
  return sweep(options);
}

} // namespace

void add_sweep_command(CLI::App& program, Action& chosen) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* command =
      program.add_subcommand("sweep", "speed against error, of both models at many resolutions");
  command->add_option("case", options->file, "case file (TOML): a box under tractions");
  command->add_option("--out", options->out, "folder for sweep.txt, sweep.csv, sweep.json and the plots");
  command->add_flag("--json", options->json, "one JSON document on standard output, and nothing else there");
  command->add_flag("--quick", options->quick, "three resolutions, one tolerance, few repetitions");
  command->add_flag("--perf", options->perf,
                    "count the instructions of the springs' kernels with valgrind instead; needs no case");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

} // namespace springproof::compare
