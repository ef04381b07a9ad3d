#include "compare/app/commands.hpp"

#include "cases/mesh/vtk.hpp"
#include "compare/app/design_options.hpp"
#include "compare/app/replay_option.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/error_bars/time_study.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/ranking/ranking.hpp"
#include "compare/report/case_page.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/thesis/table_jobs.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <memory>

namespace springproof::compare {

namespace {

struct RunOptions {
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::string only = "both";
  std::string out;
  int meshes = 0;              ///< of the finite elements' limit; 0: as the case's accuracy asks
  bool converges_time = false; ///< once more with half the step
  std::string peer;            ///< a program that is asked too; empty: none
  DisplacementOptions displacements;
  std::string replay;               ///< a recording of interact; empty: none
  std::vector<std::string> designs; ///< to be ranked, or "all"; empty: the case's own springs are solved
  bool report = false;              ///< a page of each case, in `out`
  bool json = false;
};

/// CalculiX wants all of the body in one place.
void ask_peer(const cases::Scene& scene, Answers& answers) {
  const cases::Solution fem = gathered(answers.fem.solution);
  answers.peer.emplace();
  const Answer answer = shared_from_rank_0(scene.mesh, [&] {
    answers.peer = ask_calculix(with_fem(scene, answers.resolved), fem);
    return answers.peer->answer;
  });
  answers.peer->answer = answer;
}

/// The springs of every design against the same finite elements.
int run_designs(const RunOptions& options) {
  const std::vector<Question> questions =
      read_questions(options.files, options.settings, {cases::Side::fem, options.meshes});
  check_memory(questions);
  nlohmann::ordered_json document{{"schema", 1}, {"cases", nlohmann::ordered_json::array()}};
  bool failed = false;
  ProgressLine line(1);
  const auto models_of = [&](const Question& question) {
    std::vector<Estimate> models = estimate(question);
    models.insert(models.end(), designs_of(options.designs, question.scene.definition).size(),
                  estimate_springs(size_of(question.scene)));
    return models;
  };
  for (const Question& question : questions) line.expect({1, total_seconds(models_of(question))});
  for (const Question& question : questions) {
    const cases::Case& definition = question.scene.definition;
    std::optional<ProgressLine::Shown> shown(std::in_place, line, definition.name,
                                             total_seconds(models_of(question)),
                                             long_solve_text(definition.name, estimate(question)));
    const Ranking ranking =
        rank_designs(question.scene, designs_of(options.designs, definition), options.meshes);
    shown.reset();
    if (mpi_rank() != 0) {
      failed = failed || !ranking.fem.converged();
      continue;
    }
    failed = failed || !ranking.is_sound();
    if (options.json)
      document["cases"].push_back(ranking_to_json(ranking));
    else
      write_ranking_text(std::cout, ranking);
  }
  if (mpi_rank() == 0 && options.json) std::cout << json_text(document);
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
  const ProgressLine::Shown shown(line, scene.definition.name, total_seconds(models),
                                  long_solve_text(scene.definition.name, models));
  Answers answers = solve(scene, request, solve_fem, FinishedCases::meshes_in(finished.folder(), question));
  if (!request.peer.empty()) ask_peer(scene, answers);
  finished.keep(question, answers);
  return answers;
}

/// The words of a run of one case that makes its page again.
std::vector<std::string> command_of(const RunOptions& options, const std::string& file) {
  std::vector<std::string> words{"run", file};
  const auto add = [&](const std::string& option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  for (const std::string& setting : options.settings) add("--set", setting);
  if (!options.replay.empty()) add("--replay", options.replay);
  if (options.only != "both") add("--only", options.only);
  if (options.meshes > 0) words.push_back(fmt::format("--converge={}", options.meshes));
  if (!options.peer.empty()) add("--peer", options.peer);
  if (!options.displacements.file.empty()) add("--msm-displacements", options.displacements.file);
  if (options.displacements.interpolate) words.push_back("--interpolate");
  if (!options.designs.empty()) add("--designs", fmt::format("{}", fmt::join(options.designs, ",")));
  add("--out", options.out);
  words.push_back("--report");
  return words;
}

/// The page of a case that is solved, with its designs ranked when asked. Collective.
void write_page_of(const RunOptions& options, const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  Answers answers = gathered(comparison.answers);
  std::optional<Ranking> ranking;
  if (!options.designs.empty())
    ranking = rank_designs(comparison.scene, designs_of(options.designs, definition), answers);
  run_on_all_ranks([&] {
    if (mpi_rank() != 0) return;
    Comparison whole = comparison;
    whole.answers = std::move(answers);
    write_case_page(options.out, whole, ranking ? &*ranking : nullptr,
                    {shell_command(command_of(options, definition.file))});
  });
}

int run(const RunOptions& options) {
  const auto only =
      options.displacements.file.empty() ? cases::value_of<cases::Side>(options.only) : cases::Side::fem;
  // All are read before any is solved: a mistake in the last costs nothing.
  std::vector<Question> questions =
      read_questions(options.files, options.settings, {only, options.meshes, options.peer});
  if (!options.out.empty()) { // for the .vtu
    cases::check_has_vtk();
    for (Question& question : questions) question.scene.definition.has_fields = true;
  }
  check_memory(questions);
  questions = with_recording(std::move(questions), options.replay);
  const auto external =
      read_external(questions, options.displacements.file,
                    options.displacements.interpolate ? Transfer::interpolated : Transfer::matched);
  const FinishedCases finished(options.out, questions);
  ProgressLine line(1);
  for (const Question& question : questions) line.expect({1, total_seconds(estimate(question))});
  for (const Question& question : questions)
    if (options.converges_time && !question.scene.definition.dynamics)
      throw cases::InputError(question.scene.definition.file +
                              ": --converge-time: the case has no [dynamics]");
  std::vector<Comparison> done;
  std::vector<TimeStudy> time_studies; ///< as many, if asked for
  bool failed = false;
  for (Question& question : questions) {
    Answers answers = answer(question, finished, line);
    if (external) answers = with_displacements(std::move(answers), question.scene, *external);
    done.push_back(comparison_of(std::move(question.scene), std::move(answers)));
    failed = failed || !done.back().is_sound();
    if (options.converges_time) {
      time_studies.push_back(study_time(done.back().scene, done.back().answers, question.request, solve_fem));
      failed = failed || !time_studies.back().failures.empty();
    }
    if (!options.json && mpi_rank() == 0) write_text(std::cout, done.back());
    if (!options.json && mpi_rank() == 0 && options.converges_time)
      write_time_study_text(std::cout, time_studies.back());
    if (!options.out.empty()) write_results(options.out, done);
    if (options.report) write_page_of(options, done.back());
  }
  if (mpi_rank() == 0 && options.json) {
    nlohmann::ordered_json document = to_json(done);
    for (std::size_t i = 0; i < time_studies.size(); ++i)
      document["cases"][i]["time_study"] = time_study_to_json(time_studies[i]);
    std::cout << json_text(document);
  }
  return failed ? 1 : 0;
}

} // namespace

void add_run_command(CLI::App& program, Action& chosen) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* command = program.add_subcommand("run", "solve both sides of each case and print the comparison");
  command->add_option("case", options->files, "case files (TOML)")->required();
  command
      ->add_option("--set", options->settings,
                   "override a key: material.poissons_ratio=0.3, load[0].value=[0,0,1]")
      ->allow_extra_args(false);
  CLI::Option* only = command->add_option("--only", options->only, "solve one side")
                          ->check(CLI::IsMember({"both", "fem", "msm"}));
  add_converge_option(*command, options->meshes);
  command->add_flag("--converge-time", options->converges_time,
                    "solve a dynamic case once more with half its step: the error of time integration");
  command->add_option("--peer", options->peer, "ask another program about the finite elements' side too")
      ->check(CLI::IsMember({"ccx"}));
  add_displacement_options(*command, options->displacements)->excludes(only);
  CLI::Option* out = command->add_option(
      "--out", options->out,
      "folder for results.json, comparison.csv and fields as .vtu (of several ranks: .pvtu); cases "
      "that it holds already are not solved again");
  CLI::Option* report = command->add_flag("--report", options->report,
                                          "a page of each case, CASE.html, and its bodies drawn, "
                                          "CASE_bodies/bodies.png and .svg, in the folder of --out; with "
                                          "--designs they are on it");
  report->needs(out);
  command->add_flag("--json", options->json, "one JSON document on standard output, and nothing else there");
  add_designs_option(*command, options->designs,
                     "the springs of these designs (a,b,c or all) against the same finite elements, by their "
                     "worst errors")
      ->excludes("--only")
      ->excludes("--peer")
      ->excludes("--msm-displacements");
  add_replay_option(*command, options->replay)->excludes(command->get_option("--designs"));
  command->callback([options, out, &chosen] {
    if (!options->designs.empty() && *out && !options->report)
      throw CLI::ValidationError("--designs",
                                 "goes with --out for a page alone: add --report, or leave --out out");
    chosen = [options] {
      return options->designs.empty() || options->report ? run(*options) : run_designs(*options);
    };
  });
}

} // namespace springproof::compare
