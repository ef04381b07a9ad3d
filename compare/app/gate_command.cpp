#include "compare/app/commands.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/client/ask_client.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/gates/bless.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/table/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <iostream>

namespace springproof::compare {

namespace {

struct GateOptions {
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::vector<std::string> bless; ///< names of cases
  DisplacementOptions displacements;
  std::string replay; ///< a recording of interact; empty: none
  std::string junit, out;
  int workers = 0; ///< one per core
  int meshes = 0;  ///< meshes of the finite elements' limit; 0: as the cases ask
  bool json = false, annotate = false;
  ShardOptions shards;
};

/// @throws InputError for a name that is no case's or has nothing to bless
void check_blessing(const GateOptions& options, const std::vector<Question>& questions) {
  if (!options.bless.empty() && !options.settings.empty())
    throw cases::InputError("--bless: with --set the values are not those of the case as its file has it");
  std::vector<std::string> known;
  for (const Question& question : questions) known.push_back(question.scene.definition.name);
  for (const std::string& name : options.bless) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end())
      throw cases::InputError("--bless: is \"" + name +
                              "\", must be the name of a case given: " + cases::alternatives(known));
    const cases::Case& definition =
        questions[static_cast<std::size_t>(found - known.begin())].scene.definition;
    if (!has_regression(definition))
      throw cases::InputError(
          "--bless: " + name +
          " has no expectation of reference \"regression\", and no other kind is ever blessed");
    check_named_file(blessed_file(definition));
  }
}

/// Blesses the case if it was named, prints what that changes, and judges it by its new intervals.
Comparison judge_or_bless(Comparison comparison, const GateOptions& options, std::ostream& differences) {
  const std::string& name = comparison.scene.definition.name;
  if (std::find(options.bless.begin(), options.bless.end(), name) == options.bless.end()) return comparison;
  const std::string difference = from_rank_0(mpi_rank() == 0 ? bless(comparison) : "");
  if (mpi_rank() == 0) differences << difference;
  comparison.scene.definition.expectations = cases::read_case(comparison.scene.definition.file).expectations;
  return comparison_of(std::move(comparison.scene), std::move(comparison.answers));
}

void write(const GateOptions& options, const std::vector<Comparison>& judged) {
  if (mpi_rank() != 0) return;
  if (options.json)
    std::cout << json_text(gates_to_json(judged));
  else
    write_gates_text(std::cout, judged);
  if (options.annotate) write_gates_annotations(options.json ? std::cerr : std::cout, judged);
  if (!options.junit.empty())
    write_named_file(options.junit, [&](std::ostream& out) { write_gates_junit(out, judged); });
}

/// Answers to all questions, solved now or by the shards that are merged.
std::vector<Answers> solved_or_merged(const GateOptions& options, const std::vector<Question>& questions) {
  if (options.shards.folders.empty())
    return answer_all(questions, FinishedCases(options.out, questions), solve_fem, {options.workers});
  claim_folder(options.out);
  return answers_of(read_shards(options.shards.folders), questions, FileNames::of_cases);
}

int gate(const GateOptions& options) {
  Request request;
  if (options.displacements.has_others()) request.only = cases::Side::fem;
  request.meshes = options.meshes;
  // Every case is read, and its mesh and regions looked up, before any is solved.
  std::vector<Question> questions =
      with_recording(read_questions(options.files, options.settings, request), options.replay);
  check_blessing(options, questions);
  check_named_file(options.junit);
  if (!options.out.empty()) cases::check_has_vtk(); // for the .vtu
  const auto external =
      read_external(questions, options.displacements.file,
                    options.displacements.interpolate ? Transfer::interpolated : Transfer::matched,
                    options.displacements.array);
  const auto client = read_client(questions, options.displacements.client);
  if (!options.shards.part.empty())
    return solve_shard(options.shards, questions, FileNames::of_cases, options.out, {options.workers});
  std::vector<Answers> answers = solved_or_merged(options, questions);
  std::vector<Comparison> done;
  for (std::size_t q = 0; q < questions.size(); ++q) {
    cases::Scene& scene = questions[q].scene;
    if (external) answers[q] = with_displacements(std::move(answers[q]), scene, *external);
    if (client) answers[q] = with_client(std::move(answers[q]), scene, *client);
    done.push_back(judge_or_bless(comparison_of(std::move(scene), std::move(answers[q])), options,
                                  options.json ? std::cerr : std::cout));
    if (!options.out.empty()) write_results(options.out, done);
  }
  write(options, done);
  return all_met(done) ? 0 : 1;
}

} // namespace

void add_gate_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<GateOptions>(
      program, chosen, "gate", "judge what each case expects: one line per gate", gate);
  command->add_option("case", options->files, "case files (TOML)")->required();
  add_set_option(*command, options->settings, "override a key: material.poissons_ratio=0.3");
  // A shard's record, which anybody may have made, holds no command.
  CLI::Option* client = add_displacement_options(*command, options->displacements)[1];
  add_converge_option(*command, options->meshes);
  add_replay_option(*command, options->replay);
  CLI::Option* junit = command->add_option("--junit", options->junit, "file for the verdicts as JUnit's XML");
  CLI::Option* json = add_json_option(*command, options->json);
  CLI::Option* annotate = command->add_flag(
      "--annotate", options->annotate, "GitHub's annotations too; with --json they go to standard error");
  CLI::Option* bless =
      command
          ->add_option("--bless", options->bless,
                       "names of cases whose missed regression intervals are moved to the values of now")
          ->allow_extra_args(false);
  CLI::Option* out = command->add_option("--out", options->out,
                                         "folder for results.json, comparison.csv and fields as .vtu; cases "
                                         "that it holds already are not solved again");
  bless->excludes(add_shard_options(*command, options->shards, out, {junit, json, annotate, bless, client}));
  add_workers_option(*command, options->workers);
}

} // namespace springproof::compare
