#include "cases/case/read_case.hpp"
#include "compare/app/commands.hpp"
#include "compare/app/shard_options.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/sweep/costs.hpp"
#include "compare/sweep/instructions.hpp"
#include "compare/sweep/sharded_sweep.hpp"
#include "compare/sweep/write_motion_sweep.hpp"
#include "compare/sweep/write_screen.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "compare/write/json.hpp"

#include <iostream>
#include <optional>
#include <unistd.h>

namespace springproof::compare {

namespace {

struct SweepOptions {
  std::string file, out;
  std::vector<std::string> settings; ///< keys of the case
  std::optional<double> budget;      ///< seconds
  bool json = false, quick = false, perf = false;
  ShardOptions shards;
  Extent extent() const { return quick ? Extent::quick : Extent::full; }
  TimingRules rules() const { return quick ? TimingRules{5, 0.1} : TimingRules{}; }
};

void write_plan_to(const std::string& folder, const Sweep& sweep) {
  if (!folder.empty()) write_file(folder + "/plan.txt", [&](std::ostream& out) { write_plan(out, sweep); });
}

/// What is to be solved, on a terminal and in the folder, before it is.
/// @throws InputError if a variant needs more memory than there is
void announce(const Sweep& sweep, const std::string& folder) {
  check_memory(sweep);
  if (mpi_rank() != 0) return;
  write_plan_to(folder, sweep);
  if (isatty(STDERR_FILENO)) write_plan(std::cerr, sweep);
}

void write_csv_of(const Sweep& sweep, const std::string& folder) {
  write_file(folder + "/sweep.csv", [&](std::ostream& out) { write_sweep_csv(out, sweep); });
}

void write_files(const std::string& folder, const Sweep& sweep) {
  write_file(folder + "/sweep.txt", [&](std::ostream& out) { write_sweep_text(out, sweep); });
  write_file(folder + "/sweep.json", [&](std::ostream& out) { out << json_text(sweep_to_json(sweep)); });
  plot_sweep(folder, sweep);
}

Sweep planned(const SweepOptions& options) {
  const cases::Case definition = cases::read_case(options.file, options.settings);
  check_same_on_ranks("cases", n_mpi_ranks() > 1 ? cases::to_bytes(definition) : "");
  Sweep sweep = make_sweep(definition, options.extent(), options.rules(), options.budget);
  sweep.settings = options.settings;
  return sweep;
}

int time_part(const SweepOptions& options) {
  const Shard shard = shard_from(options.shards.part).value();
  const Sweep whole = planned(options);
  claim_folder(options.out);
  announce(whole, options.out);
  const TimedPart part = time_shard(whole, shard, options.out, options.shards.command, "/proc/self/exe");
  if (mpi_rank() == 0)
    print_shard(shard, part.n_variants, whole.plan.variants.size(), part.n_failed, options.out);
  return 0;
}

Sweep time_all(const SweepOptions& options) {
  claim_folder(options.out);
  const Sweep whole = planned(options);
  announce(whole, options.out);
  // What is finished is on disk before the next variant starts.
  return run_sweep(whole, "/proc/self/exe", [&](const Sweep& so_far) {
    if (mpi_rank() == 0 && !options.out.empty()) write_csv_of(so_far, options.out);
  });
}

Sweep merge_parts(const SweepOptions& options) {
  Sweep merged = merged_sweep(planned(options), read_shards(options.shards.folders));
  claim_folder(options.out);
  write_plan_to(options.out, merged);
  if (!options.out.empty()) write_csv_of(merged, options.out);
  return merged;
}

/// Sweeps a dynamic case.
int sweep_in_time(const SweepOptions& options, const cases::Case& definition) {
  if (n_mpi_ranks() > 1 || options.budget || !options.shards.part.empty() || !options.shards.folders.empty())
    throw cases::InputError(definition.file +
                            ": dynamics: a sweep in time has no --budget and no parts, and runs on one rank");
  claim_folder(options.out);
  const auto write_csv = [&](const MotionSweep& so_far) {
    if (options.out.empty()) return;
    write_file(options.out + "/motion_sweep.csv",
               [&](std::ostream& out) { write_motion_sweep_csv(out, so_far); });
  };
  MotionSweep result = sweep_motion(definition, options.extent(), write_csv);
  result.settings = options.settings;
  if (options.json)
    std::cout << json_text(motion_sweep_to_json(result));
  else
    write_motion_sweep_screen(std::cout, result, options.out);
  if (!options.out.empty()) {
    write_file(options.out + "/motion_sweep.txt",
               [&](std::ostream& out) { write_motion_sweep_text(out, result); });
    write_file(options.out + "/motion_sweep.json",
               [&](std::ostream& out) { out << json_text(motion_sweep_to_json(result)); });
    plot_motion_sweep(options.out, result);
  }
  return has_answer(result) ? 0 : 1;
}

int sweep(const SweepOptions& options) {
  if (const cases::Case definition = cases::read_case(options.file, options.settings); definition.dynamics)
    return sweep_in_time(options, definition);
  if (!options.shards.part.empty()) return time_part(options);
  const Sweep result = options.shards.folders.empty() ? time_all(options) : merge_parts(options);
  const int status = has_answer(result) ? 0 : 1; // a model that failed is a row with its reason
  if (mpi_rank() != 0) return status;
  if (options.json)
    std::cout << json_text(sweep_to_json(result));
  else
    write_sweep_screen(std::cout, result, options.out);
  if (!options.out.empty()) write_files(options.out, result);
  return status;
}

int count(const SweepOptions& options) {
  if (mpi_rank() != 0) return 0;
  const InstructionCounts counts = count_instructions();
  if (!counts.reason.empty()) {
    print(std::cerr, "{}\n", counts.reason);
    return 2;
  }
  if (options.json)
    std::cout << json_text(instructions_to_json(counts));
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
  const auto [command, options] = add_command<SweepOptions>(
      program, chosen, "sweep", "speed against error, of both models at many resolutions", run);
  command->add_option("case", options->file, "case file (TOML): a box under tractions, or in motion");
  add_set_option(*command, options->settings, "override a key: material.poissons_ratio=0.3");
  CLI::Option* out =
      command->add_option("--out", options->out, "folder for sweep.txt, sweep.csv, sweep.json and the plots");
  CLI::Option* json = add_json_option(*command, options->json);
  command->add_flag("--quick", options->quick, "three resolutions, one tolerance, few repetitions");
  command
      ->add_option("--budget", options->budget,
                   "seconds: leave out the variants of the longest estimated times until the others fit")
      ->check(number_between(1e-3, 1e9));
  CLI::Option* perf = command->add_flag(
      "--perf", options->perf,
      "count the instructions of the springs' kernels with valgrind instead; needs no case");
  add_shard_options(*command, options->shards, out, {json, perf});
}

} // namespace springproof::compare
