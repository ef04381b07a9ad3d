#include "compare/app/commands.hpp"

#include "cases/case/names.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/app/typed_command.hpp"
#include "compare/client/ask_client.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/peers/peer_study.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/report/pages.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/study/error_budget.hpp"
#include "compare/study/write_study.hpp"
#include "compare/table/table.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

namespace springproof::compare {

namespace {

struct RunOptions {
  const CLI::App* program = nullptr; ///< whose name is what was typed
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::string only = "both";
  std::string out;
  int meshes = 0;                ///< meshes of the finite elements' limit; 0: as the case asks
  bool converges_time = false;   ///< once more with half the step
  bool has_error_budget = false; ///< law, mesh, step and iterations apart
  std::string peer;              ///< a program that is asked too; empty: none
  bool has_second_code() const { return peer == "getfem"; } ///< which has limits of its own
  DisplacementOptions displacements;
  std::string replay;               ///< a recording of interact; empty: none
  std::vector<std::string> designs; ///< to be ranked, or "all"; empty: the case's own springs are solved
  bool report = false;              ///< a page of each case, in `out`
  bool json = false;
};

/// A command line of `run` for the same case with these words after it, without the settings that begin with
/// one of these texts.
std::string line_of(const RunOptions& run, const cases::Case& definition,
                    const std::vector<std::string>& more = {},
                    const std::vector<std::string>& left_out = {}) {
  std::vector<std::string> words{run.program->get_name(), "run", definition.file};
  for (const std::string& setting : run.settings)
    if (std::none_of(left_out.begin(), left_out.end(),
                     [&](const std::string& beginning) { return setting.rfind(beginning, 0) == 0; }))
      words.insert(words.end(), {"--set", setting});
  const auto adds = [&](const char* word) { return std::find(more.begin(), more.end(), word) != more.end(); };
  if (!run.displacements.client.empty() && !adds("--only"))
    words.insert(words.end(), {"--client", run.displacements.client});
  if (!run.replay.empty()) words.insert(words.end(), {"--replay", run.replay});
  words.insert(words.end(), more.begin(), more.end());
  return shell_line(words);
}

/// Cells of half the edge, where both models can be solved on them soon and mean the same: forces on nodes
/// would be other loads, and given springs are of the cells that they were given for.
std::optional<std::array<int, 3>> finer_cells(const Comparison& comparison) {
  constexpr std::size_t most_cells = 40000;
  const cases::Case& definition = comparison.scene.definition;
  const auto* box = std::get_if<cases::Box>(&definition.body);
  const bool is_given = cases::facts_of(definition.msm.design).source == cases::DesignSource::file;
  if (!box || cases::has_nodal_forces(definition.loads) || is_given ||
      8 * comparison.scene.mesh.cells.size() > most_cells)
    return std::nullopt;
  std::array<int, 3> cells = box->cells;
  for (int& n : cells) n *= 2;
  return cells;
}

/// What tells whether the mesh is fine enough.
std::optional<NextCommand> about_mesh(const RunOptions& run, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  if (!comparison.mesh_study && run.meshes == 0)
    return NextCommand{line_of(run, definition, {"--converge"}), "this mesh's own error"};
  if (const auto cells = finer_cells(comparison))
    return NextCommand{line_of(run, definition,
                               {"--set", fmt::format("body.cells=[{}]", fmt::join(*cells, ","))},
                               {"body.cells="}),
                       "a finer mesh"};
  return std::nullopt;
}

/// The [msm] table of a design as with_design() makes it.
std::string msm_setting(const std::string& design, const cases::Msm& own) {
  std::string table = fmt::format("msm={{design=\"{}\"", design);
  if (own.mass != cases::Msm{}.mass) table += fmt::format(", mass=\"{}\"", cases::name_of(own.mass));
  std::vector<std::string> accepted;
  for (const cases::Doubt doubt : own.accepted) accepted.push_back('"' + cases::name_of(doubt) + '"');
  if (!accepted.empty()) table += fmt::format(", accept=[{}]", fmt::join(accepted, ", "));
  return table + "}";
}

/// What a run leaves open: other designs, the mesh, the files.
std::vector<NextCommand> next_commands(const RunOptions& run, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  const Answers& answers = comparison.answers;
  const auto is_skipped = [](const Answer& side) { return side.solution.status == cases::Status::skipped; };
  if (!cases::has_finite_elements(definition)) {
    if (!run.out.empty() || answers.failed()) return {};
    return {{line_of(run, definition, {"--only", "msm", "--out", "out", "--report"}), "files and a page"}};
  }
  if (is_skipped(answers.fem) || is_skipped(answers.msm)) return {{line_of(run, definition), "both models"}};
  std::vector<NextCommand> next;
  if (answers.fem.converged() && answers.msm_source.empty() && !comparison.measures.empty() &&
      cases::has_cells(definition.body))
    next.push_back({line_of(run, definition, {"--designs", "all"}),
                    answers.msm.converged() ? "other designs" : "designs that may hold here"});
  if (answers.fem.converged() && answers.msm.converged())
    if (auto mesh = about_mesh(run, comparison)) next.push_back(std::move(*mesh));
  if (!answers.fem.converged())
    next.push_back({line_of(run, definition, {"--only", "msm"}), "the springs by themselves"});
  if (run.out.empty() && !answers.failed())
    next.push_back({line_of(run, definition, {"--out", "out", "--report"}), "files and a page"});
  return next;
}

/// The recommended design by itself, and the files.
std::vector<NextCommand> next_commands(const RunOptions& run, const cases::Case& definition,
                                       const Ranking& ranking) {
  const cases::Msm& own = definition.msm;
  std::vector<NextCommand> next;
  const Trial* best = ranking.recommended();
  if (best && best->name != cases::name_of(own.design))
    next.push_back({line_of(run, definition, {"--set", msm_setting(best->name, own)}, {"msm=", "msm."}),
                    "this design by itself"});
  if (run.out.empty())
    next.push_back({line_of(run, definition, {"--designs", "all", "--out", "out"}),
                    "the springs of each design, in files"});
  return next;
}

void print_ranking(const RunOptions& options, const cases::Case& definition, const Ranking& ranking) {
  write_ranking_text(std::cout, ranking);
  if (!options.out.empty())
    write_wrapped(std::cout,
                  "Springs of each design and all errors: " + options.out +
                      "/ranking.json; this table: ranking.txt and ranking.csv there",
                  2);
  write_next_commands(std::cout, next_commands(options, definition, ranking));
}

/// A question's finite elements, and as many springs as there are designs.
std::vector<Estimate> estimate_designs(const RunOptions& options, const Question& question) {
  std::vector<Estimate> models = estimate(question);
  models.insert(models.end(), designs_of(options.designs, question.scene.definition).size(),
                estimate_springs(size_of(question.scene)));
  return models;
}

/// The springs of every design against the same finite elements.
int run_designs(const RunOptions& options) {
  auto questions = read_questions(options.files, options.settings, {cases::Side::fem, options.meshes});
  check_memory(questions);
  questions = with_recording(std::move(questions), options.replay);
  claim_folder(options.out);
  std::vector<Ranking> rankings;
  bool failed = false;
  ProgressLine line(1);
  for (const Question& question : questions) line.expect(total_seconds(estimate_designs(options, question)));
  for (const Question& question : questions) {
    const cases::Case& definition = question.scene.definition;
    line.begin(definition.name, total_seconds(estimate_designs(options, question)),
               long_solve_text(definition.name, estimate(question)));
    rankings.push_back(rank_designs(question.scene, designs_of(options.designs, definition), options.meshes));
    line.finish(definition.name);
    const Ranking& ranking = rankings.back();
    if (mpi_rank() != 0) { // the other ranks' rankings have no designs
      failed = failed || !ranking.fem.converged();
      continue;
    }
    failed = failed || !ranking.is_sound();
    if (!options.out.empty()) write_rankings(options.out, rankings);
    if (!options.json) print_ranking(options, definition, ranking);
  }
  if (mpi_rank() == 0 && options.json) std::cout << json_text(rankings_to_json(rankings));
  return failed ? 1 : 0;
}

/// Solves a case, or takes up what an earlier run has left in the same folder. Collective.
Answers answer(const Question& question, const FinishedCases& finished, ProgressLine& line) {
  const std::vector<Estimate> models = estimate(question);
  if (auto earlier = finished.find(question)) {
    line.skip(total_seconds(models));
    return *earlier;
  }
  const auto& [scene, request] = question;
  const std::string& name = scene.definition.name;
  line.begin(name, total_seconds(models), long_solve_text(name, models));
  Answers answers =
      solve(scene, request, solve_fem, FinishedCases::meshes_in(finished.folder(), question), ask_calculix);
  finished.keep(question, answers);
  line.finish(name);
  return answers;
}

/// What a run has found of its cases so far.
struct Results {
  std::vector<Comparison> done;
  std::vector<TimeStudy> time_studies; ///< as many, if asked for
  std::vector<ErrorBudgets> budgets;   ///< likewise
  std::vector<PeerStudy> peer_studies; ///< likewise
  std::vector<Ranking> rankings;       ///< likewise
};

/// The page of the case that was solved last, with its designs ranked when asked. Collective.
void write_page(const RunOptions& options, const Results& results) {
  const Comparison& comparison = results.done.back();
  Answers answers = gathered(comparison.answers);
  run_on_all_ranks([&] {
    if (mpi_rank() != 0) return;
    Comparison whole = comparison;
    whole.answers = std::move(answers);
    write_case_page(options.out, whole, results.rankings.empty() ? nullptr : &results.rankings.back(),
                    {typed_command()}, results.budgets.empty() ? nullptr : &results.budgets.back());
  });
}

/// The text of the case that was solved last, on rank 0.
void print_last(const RunOptions& options, const Results& results) {
  const Comparison& comparison = results.done.back();
  const cases::Case& definition = comparison.scene.definition;
  write_text(std::cout, comparison, options.meshes > 0 ? MeshTable::printed : MeshTable::left_out);
  if (options.converges_time) write_time_study_text(std::cout, results.time_studies.back());
  if (options.has_second_code()) write_peer_study_text(std::cout, results.peer_studies.back());
  if (options.has_error_budget) write_error_budget_text(std::cout, results.budgets.back());
  if (!options.out.empty())
    write_wrapped(std::cout,
                  fmt::format("  files    {}/results.json, comparison.csv, {}.{}{}", options.out,
                              definition.name, n_mpi_ranks() > 1 ? "pvtu" : "vtu",
                              options.report ? ", " + definition.name + ".html" : ""),
                  11);
  const bool is_ranked = !results.rankings.empty();
  write_verdict_text(std::cout, comparison,
                     is_ranked ? std::vector<NextCommand>{} : next_commands(options, comparison));
  if (is_ranked) print_ranking(options, definition, results.rankings.back());
}

/// The files of the cases that are solved. Collective.
void write_files(const RunOptions& options, const Results& results) {
  if (options.out.empty()) return;
  write_results(options.out, results.done);
  if (mpi_rank() == 0 && !results.rankings.empty()) write_rankings(options.out, results.rankings);
  if (options.report) write_page(options, results);
}

nlohmann::ordered_json results_to_json(const Results& results) {
  nlohmann::ordered_json document = to_json(results.done);
  const auto add = [&](const char* key, const auto& records, const auto& record_to_json) {
    for (std::size_t i = 0; i < records.size(); ++i) document["cases"][i][key] = record_to_json(records[i]);
  };
  add("time_study", results.time_studies, time_study_to_json);
  add("peer_study", results.peer_studies, peer_study_to_json);
  add("error_budget", results.budgets, error_budgets_to_json);
  add("ranking", results.rankings, ranking_to_json);
  return document;
}

int run_comparisons(const RunOptions& options) {
  if (!options.peer.empty() && options.only == "msm")
    throw cases::InputError("run: --peer is asked about the finite elements' side; leave --only msm out");
  const auto only =
      options.displacements.has_others() ? cases::Side::fem : cases::value_of<cases::Side>(options.only);
  // All are read before any is solved: a mistake in the last costs nothing.
  std::vector<Question> questions = read_questions(
      options.files, options.settings, {only, options.meshes, options.has_second_code() ? "" : options.peer});
  for (const Question& question : questions)
    if (const cases::Fem& fem = question.scene.definition.fem; fem.real_time && !options.peer.empty())
      throw cases::InputError(fem.where,
                              "real_time must be left out with --peer, which solves every equation");
  if (!options.out.empty()) { // for the .vtu
    cases::check_has_vtk();
    for (Question& question : questions) question.scene.definition.has_fields = true;
  }
  if (n_mpi_ranks() > 1 && (options.has_error_budget || options.has_second_code()))
    throw cases::InputError(
        fmt::format("{}: it runs on one rank; start the program without mpirun",
                    options.has_error_budget ? "--error-budget" : "--peer " + options.peer));
  if (options.has_error_budget) // the truth is a limit
    for (Question& question : questions) {
      cases::refuse_network(question.scene.definition, "--error-budget",
                            "the error itself is told without it");
      if (question.scene.definition.measures.empty())
        throw cases::InputError(question.scene.definition.file +
                                ": --error-budget: the case has no [[measure]]; add one");
      question.scene.definition.fem.has_auto_accuracy = true;
    }
  check_memory(questions);
  questions = with_recording(std::move(questions), options.replay);
  const auto external =
      read_external(questions, options.displacements.file,
                    options.displacements.interpolate ? Transfer::interpolated : Transfer::matched,
                    options.displacements.array);
  const auto client = read_client(questions, options.displacements.client);
  const FinishedCases finished(options.out, questions);
  ProgressLine line(1);
  for (const Question& question : questions) line.expect(total_seconds(estimate(question)));
  if (options.converges_time)
    for (const Question& question : questions) check_time_study(question.scene, question.request);
  Results results;
  bool failed = false;
  for (Question& question : questions) {
    Answers answers = answer(question, finished, line);
    if (external) answers = with_displacements(std::move(answers), question.scene, *external);
    if (client) answers = with_client(std::move(answers), question.scene, *client);
    results.done.push_back(comparison_of(std::move(question.scene), std::move(answers)));
    const Comparison& comparison = results.done.back();
    failed = failed || !comparison.is_sound();
    if (options.converges_time) {
      results.time_studies.push_back(
          study_time(comparison.scene, comparison.answers, question.request, solve_fem));
      failed = failed || !results.time_studies.back().failures.empty();
    }
    if (options.has_second_code()) {
      results.peer_studies.push_back(study_by_getfem(comparison));
      failed = failed || results.peer_studies.back().status == cases::Status::failed;
    }
    if (options.has_error_budget) {
      results.budgets.push_back(study_errors(comparison, question.request));
      // Without parts a model has no answer, or none with half the step.
      failed = failed || results.budgets.back().springs.empty();
    }
    if (!options.designs.empty()) {
      results.rankings.push_back(rank_designs(comparison.scene,
                                              designs_of(options.designs, comparison.scene.definition),
                                              gathered(comparison.answers)));
      failed = failed || (mpi_rank() == 0 && !results.rankings.back().is_sound());
    }
    if (!options.json && mpi_rank() == 0) print_last(options, results);
    write_files(options, results);
  }
  if (mpi_rank() == 0 && options.json) std::cout << json_text(results_to_json(results));
  return failed ? 1 : 0;
}

int run(const RunOptions& options) {
  return options.designs.empty() || options.report ? run_comparisons(options) : run_designs(options);
}

} // namespace

void add_run_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<RunOptions>(
      program, chosen, "run", "solve both sides of each case and print the comparison", run);
  command->add_option("case", options->files, "case files (TOML)")->required();
  add_set_option(*command, options->settings,
                 "override a key: material.poissons_ratio=0.3, load[0].value=[0,0,1]");
  CLI::Option* only = command->add_option("--only", options->only, "solve one side")
                          ->check(CLI::IsMember({"both", "fem", "msm"}));
  add_converge_option(*command, options->meshes);
  command->add_flag("--converge-time", options->converges_time,
                    "solve a dynamic case once more with half its step: the error of time integration");
  command
      ->add_option(
          "--peer", options->peer,
          "ask another program about the finite elements' side too: ccx on the same mesh, getfem for "
          "the limit of its own meshes")
      ->check(CLI::IsMember({"ccx", "getfem"}));
  for (CLI::Option* others : add_displacement_options(*command, options->displacements))
    others->excludes(only)->excludes("--converge-time"); // which halves our own step
  command
      ->add_flag("--error-budget", options->has_error_budget,
                 "the springs on finer lattices, a motion with half its step: how much of each error is of "
                 "the law, the mesh, the step and the iterations")
      ->excludes(only)
      ->excludes("--msm-displacements")
      ->excludes("--client");
  CLI::Option* out = command->add_option(
      "--out", options->out,
      "folder for results.json, comparison.csv and fields as .vtu (of several ranks: .pvtu); cases "
      "that it holds already are not solved again; with --designs for ranking.txt, .csv and .json");
  CLI::Option* report = command->add_flag("--report", options->report,
                                          "a page of each case, CASE.html, and its bodies drawn, "
                                          "CASE_bodies/bodies.png and .svg, in the folder of --out; with "
                                          "--designs they are on it");
  report->needs(out);
  add_json_option(*command, options->json);
  add_designs_option(*command, options->designs,
                     "the springs of these designs (a,b,c or all) against the same finite elements, by their "
                     "worst errors")
      ->excludes("--only")
      ->excludes("--peer")
      ->excludes("--msm-displacements")
      ->excludes("--client");
  add_replay_option(*command, options->replay);
  options->program = &program;
}

} // namespace springproof::compare
