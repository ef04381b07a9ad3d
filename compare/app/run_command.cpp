#include "compare/app/commands.hpp"

#include "cases/case/names.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/ranks.hpp"
#include "compare/solve/solve_jobs.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

#include <iostream>
#include <memory>

namespace springproof::compare {

namespace {

struct RunOptions {
  std::vector<std::string> files;
  std::vector<std::string> settings;
  std::string only = "both";
  std::string out;
  int meshes = 0;            ///< of the finite elements' limit; 0: as the case's accuracy asks
  std::string peer;          ///< a program that is asked too; empty: none
  std::string displacements; ///< file of another simulator's, in place of our springs
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

int run(const RunOptions& options) {
  const auto only =
      options.displacements.empty() ? cases::value_of<cases::Side>(options.only) : cases::Side::fem;
  // All are read before any is solved: a mistake in the last costs nothing.
  std::vector<Question> questions =
      read_questions(options.files, options.settings, {only, options.meshes, options.peer});
  check_memory(questions);
  const auto external = read_external(questions, options.displacements);
  const FinishedCases finished(options.out, questions);
  ProgressLine line(1);
  for (const Question& question : questions) line.expect({1, total_seconds(estimate(question))});
  std::vector<Comparison> done;
  bool failed = false;
  for (Question& question : questions) {
    Answers answers = answer(question, finished, line);
    if (external) answers = with_displacements(std::move(answers), question.scene.mesh, *external);
    done.push_back(comparison_of(std::move(question.scene), std::move(answers)));
    failed = failed || !done.back().is_sound();
    if (!options.json && mpi_rank() == 0) write_text(std::cout, done.back());
    if (!options.out.empty()) write_results(options.out, done);
  }
  if (mpi_rank() == 0 && options.json) std::cout << json_text(to_json(done));
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
  command->add_option("--peer", options->peer, "ask another program about the finite elements' side too")
      ->check(CLI::IsMember({"ccx"}));
  command
      ->add_option(
          "--msm-displacements", options->displacements,
          "another simulator's displacements (.csv: x,y,z,ux,uy,uz, or .vtu) in place of our springs")
      ->excludes(only);
  command->add_option(
      "--out", options->out,
      "folder for results.json, comparison.csv and fields as .vtu (of several ranks: .pvtu); cases "
      "that it holds already are not solved again");
  command->add_flag("--json", options->json, "one JSON document on standard output, and nothing else there");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

} // namespace springproof::compare
