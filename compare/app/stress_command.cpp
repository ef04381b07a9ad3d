#include "compare/app/commands.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/hard/stress.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/table/json.hpp"

#include <filesystem>
#include <iostream>

namespace springproof::compare {

namespace {

struct StressOptions {
  std::vector<std::string> names;
  std::string out;
  int n_threads = 1;
  bool all = false;
  bool json = false;
};

/// @param name  a hard case's name, or a path
std::string file_of(const std::string& name) {
  if (std::filesystem::path(name).extension() == ".toml") return name;
  const std::map<std::string, std::string> hard = case_files_in("hard");
  if (const auto found = hard.find(name); found != hard.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [known_name, file] : hard) known.push_back(known_name);
  const auto nearest = cases::nearest_name(name, known);
  throw cases::InputError(
      "stress: there is no hard case \"" + name + "\"" +
      (nearest ? "; did you mean \"" + *nearest + "\"?"
               : ", allowed are " + cases::alternatives(known) + ", or the path of a .toml file"));
}

/// Reads every case before any is solved: without names all, the heavy ones only if they are asked for.
std::vector<cases::Case> read_all(const StressOptions& options, std::vector<std::string>& skipped) {
  std::vector<std::string> files;
  for (const std::string& name : options.names) files.push_back(file_of(name));
  if (files.empty())
    for (const auto& [name, file] : case_files_in("hard")) files.push_back(file);
  std::vector<cases::Case> hard;
  for (const std::string& file : files) {
    cases::Case next = cases::read_hard_case(file);
    if (next.stress->is_heavy && options.names.empty() && !options.all)
      skipped.push_back(next.name);
    else
      hard.push_back(std::move(next));
  }
  return hard;
}

/// What the models of a hard case take, before its mesh is made: a second for bodies that are no boxes.
/// @throws InputError if they need more memory than there is
std::vector<double> estimated_seconds(const cases::Case& hard_case) {
  std::vector<double> seconds;
  for (const cases::ExpectedOutcome& expected : hard_case.stress->expected) {
    const auto box = size_of(hard_case);
    const auto models = box ? estimate(*box, {expected.side}) : std::vector<Estimate>{{"", 0, 0, 1}};
    check_memory(hard_case.file, models, memory_limit());
    seconds.push_back(total_seconds(models));
  }
  return seconds;
}

/// What each model of a hard case answers. The jobs are solved one after the other: their times are judged.
std::vector<Answer> answers_to(const cases::Case& hard_case, const FinishedCases& finished, int n_threads,
                               ProgressLine& line) {
  std::vector<Answer> answers(hard_case.stress->expected.size());
  std::vector<Question> jobs;
  try {
    jobs = jobs_for(hard_case, n_threads);
  } catch (const cases::InputError& error) {
    for (Answer& answer : answers) answer.solution = failed_solution(error);
    for (const double seconds : estimated_seconds(hard_case)) line.skip(seconds);
    return answers;
  }
  SolveOptions options;
  options.n_workers = 1;
  options.line = &line;
  const std::vector<Answers> solved = answer_all(jobs, finished, solve_fem, options);
  for (std::size_t j = 0; j < jobs.size(); ++j)
    answers[j] = jobs[j].request.only == cases::Side::fem ? solved[j].fem : solved[j].msm;
  for (Answer& one : answers) one.solution = gathered(std::move(one.solution));
  return answers;
}

/// Finished results are on disk before the next case starts.
void write_results(const std::string& folder, const std::vector<StressResult>& results,
                   const std::vector<std::string>& skipped) {
  write_file(folder + "/stress.txt", [&](std::ostream& out) {
    for (const StressResult& result : results) write_stress_text(out, result);
    write_stress_summary(out, results, skipped);
  });
  write_file(folder + "/stress.json",
             [&](std::ostream& out) { out << json_text(stress_to_json(results, skipped)); });
}

int run(const StressOptions& options) {
  const int rank = mpi_rank();
  std::vector<std::string> skipped;
  std::vector<StressResult> results;
  bool met = true;
  const std::vector<cases::Case> hard = read_all(options, skipped);
  const FinishedCases finished(options.out, {});
  ProgressLine line(1);
  for (const cases::Case& hard_case : hard)
    for (const double seconds : estimated_seconds(hard_case)) line.expect(seconds);
  for (const cases::Case& hard_case : hard) {
    results.push_back(
        judge_stress(hard_case, options.n_threads, answers_to(hard_case, finished, options.n_threads, line)));
    met = met && results.back().met();
    if (rank != 0) continue;
    if (!options.json) write_stress_text(std::cout, results.back());
    if (!options.out.empty()) write_results(options.out, results, skipped);
  }
  if (rank != 0) return 0;
  if (options.json)
    std::cout << json_text(stress_to_json(results, skipped));
  else
    write_stress_summary(std::cout, results, skipped);
  return met ? 0 : 1;
}

} // namespace

void add_stress_command(CLI::App& program, Action& chosen) {
  const auto [command, options] =
      add_command<StressOptions>(program, chosen, "stress", "the hard cases: does each end as it must?", run);
  command->add_option("case", options->names,
                      "names of hard cases, or paths of their files; all but the heavy ones when left out");
  command->add_flag("--all", options->all, "the heavy ones too");
  command->add_option("--threads", options->n_threads, "of the springs' solver on grids of cells")
      ->check(CLI::Range(1, 1024));
  command->add_option("--out", options->out, "folder for stress.txt and stress.json");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
