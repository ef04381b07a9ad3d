#include "cases/mesh/vtk_functions.hpp"
#include "compare/app/commands.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/report/pages.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/table/json.hpp"
#include "compare/thesis/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

namespace springproof::compare {

namespace {

struct TablesOptions {
  std::vector<std::string> tables;
  std::string out;
  int workers = 0; ///< one per core
  bool json = false, trace = false;
  ShardOptions shards;
};

/// Solves what the tables need, or takes it from the shards that are merged.
ThesisResults results_of(const TablesOptions& options) {
  const std::vector<std::string>& shards = options.shards.folders;
  const int n_workers = options.workers > 0 ? options.workers : cores();
  const auto answer = [&](const std::vector<Question>& questions) {
    if (!shards.empty()) return answers_of(read_shards(shards), questions, FileNames::of_questions);
    std::vector<Answers> answers = answer_all(questions, FinishedCases("", {}), solve_fem, {n_workers});
    for (Answers& one : answers) one = gathered(std::move(one));
    return answers;
  };
  return regenerate(options.tables, answer,
                    shards.empty() ? std::to_string(n_workers) : fmt::format("{} shards", shards.size()));
}

int tables(const TablesOptions& options) {
  if (!options.shards.part.empty())
    return solve_shard(options.shards, questions_of(jobs_of_tables(options.tables)), FileNames::of_questions,
                       options.out, {options.workers});
  if (!options.out.empty()) cases::check_has_vtk(); // for the .vtu
  claim_folder(options.out);
  claim_subfolder(options.out, "figures");
  ThesisResults results = results_of(options);
  if (mpi_rank() != 0) return 0;
  Stopwatch stopwatch;
  if (options.json)
    std::cout << json_text(results_to_json(results));
  else if (options.trace)
    write_audit_text(std::cout, results);
  else
    write_tables_text(std::cout, results);
  if (!options.json && !options.trace) write_where_text(std::cout, results, options.out);
  if (!options.out.empty()) write_thesis_files(options.out, results);
  results.times.push_back({"writing", stopwatch.lap()});
  if (!options.out.empty()) {
    const std::vector<Figure> figures = draw_figures(options.out + "/figures", results);
    results.times.push_back({"figures", stopwatch.lap()});
    write_report(options.out, results, figures);
    results.times.push_back({"report", stopwatch.lap()});
  }
  for (const auto& [phase, seconds] : results.times)
    std::cerr << fmt::format("{:<44} {:>8.2f} s\n", phase, seconds);
  const bool has_failed = std::any_of(results.entries.begin(), results.entries.end(),
                                      [](const TableEntry& entry) { return entry.has_failed(); });
  return has_failed ? 1 : 0;
}

} // namespace

void add_tables_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<TablesOptions>(
      program, chosen, "tables", "regenerate the thesis's tables, ours beside the published", tables);
  command->add_option("table", options->tables,
                      "numbers of tables; without any: all, designs and advice too");
  CLI::Option* out = command->add_option(
      "--out", options->out,
      "folder for report.html, the figures, the tables as text, CSV and JSON, and fields as .vtu");
  add_workers_option(*command, options->workers);
  command->add_flag("--trace", options->trace,
                    "the audit in place of the tables: every reference, and the command that repeats it");
  CLI::Option* json = add_json_option(*command, options->json);
  add_shard_options(*command, options->shards, out, {json});
}

} // namespace springproof::compare
