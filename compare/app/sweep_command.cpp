#include "cases/case/read_case.hpp"
#include "compare/app/commands.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/fields.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/sweep/at_rate.hpp"
#include "compare/table/table.hpp"

#include <iostream>
#include <optional>
#include <unistd.h>

namespace springproof::compare {

namespace {

struct SweepOptions {
  std::string file, out;
  std::vector<std::string> settings; ///< keys of the case
  std::optional<double> budget;      ///< seconds
  std::optional<double> hertz;       ///< frames a second
  bool json = false, quick = false, perf = false;
  Extent extent() const { return quick ? Extent::quick : Extent::full; }
  TimingRules rules() const { return quick ? TimingRules{5, 0.1} : TimingRules{}; }
};

/// What is to be solved, on a terminal and in the folder, before it is.
/// @throws InputError if a variant needs more memory than there is
void announce(const Sweep& sweep, const std::string& folder) {
  check_memory(sweep);
  if (mpi_rank() != 0) return;
  if (!folder.empty()) write_file(folder + "/plan.txt", [&](std::ostream& out) { write_plan(out, sweep); });
  if (isatty(STDERR_FILENO)) write_plan(std::cerr, sweep);
}

/// The names of the files but for their endings.
std::string file_name(const Sweep& sweep, const std::string& folder) {
  return folder + (sweep.rate ? "/rate_sweep" : sweep.definition.dynamics ? "/motion_sweep" : "/sweep");
}

/// What is finished is on disk before the next variant starts.
void write_csv_of(const Sweep& sweep, const std::string& folder) {
  if (mpi_rank() == 0 && !folder.empty())
    write_file(file_name(sweep, folder) + ".csv", [&](std::ostream& out) { write_sweep_csv(out, sweep); });
}

void write_files(const std::string& folder, const Sweep& sweep) {
  write_file(file_name(sweep, folder) + ".txt", [&](std::ostream& out) { write_sweep_text(out, sweep); });
  write_json_file(file_name(sweep, folder) + ".json", sweep_to_json(sweep));
  plot_sweep(folder, sweep);
}

Sweep time_all(const SweepOptions& options, const cases::Case& definition) {
  const auto write_csv = [&](const Sweep& so_far) { write_csv_of(so_far, options.out); };
  if (options.hertz) {
    if (n_mpi_ranks() > 1) throw cases::InputError("sweep --at: runs on one rank; start it without mpirun");
    Rate rate{*options.hertz};
    rate.budget_seconds = options.budget.value_or(rate.budget_seconds);
    claim_folder(options.out);
    return sweep_at_rate(definition, rate, options.extent(), write_csv);
  }
  if (definition.dynamics) {
    if (n_mpi_ranks() > 1 || options.budget)
      throw cases::InputError(definition.file +
                              ": dynamics: a sweep in time has no --budget, and runs on one rank");
    claim_folder(options.out);
    return sweep_motion(definition, options.extent(), write_csv);
  }
  claim_folder(options.out);
  check_same_on_ranks(n_mpi_ranks() > 1 ? cases::to_bytes(definition) : "");
  const Sweep whole = make_sweep(definition, options.extent(), options.rules(), options.budget);
  announce(whole, options.out);
  return run_sweep(whole, "/proc/self/exe", write_csv);
}

int sweep(const SweepOptions& options) {
  Sweep result = time_all(options, cases::read_case(options.file, options.settings));
  result.settings = options.settings;
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
  command->add_option("case", options->file,
                      "case file (TOML): a box under tractions, or in motion; with --at any body");
  add_set_option(*command, options->settings, "override a key: material.poissons_ratio=0.3");
  command->add_option("--out", options->out, "folder for sweep.txt, sweep.csv, sweep.json and the plots");
  add_json_option(*command, options->json);
  command->add_flag("--quick", options->quick, "three resolutions, one tolerance, few repetitions");
  command
      ->add_option(
          "--budget", options->budget,
          "seconds: leave out the variants of the longest estimated times until the others fit; with "
          "--at, of the search (default 60)")
      ->check(number_between(1e-3, 1e9));
  auto* at = command
                 ->add_option("--at", options->hertz,
                              "Hz: search for the springs, cells, method, substeps and iterations to use at "
                              "this rate, by halving")
                 ->check(number_between(1, 1e4));
  command
      ->add_flag("--perf", options->perf,
                 "count the instructions of the springs' kernels with valgrind instead; needs no case")
      ->excludes(at);
}

} // namespace springproof::compare
