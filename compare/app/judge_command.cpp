#include "compare/app/commands.hpp"

#include "cases/case/error.hpp"
#include "compare/client/judge.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <iostream>

namespace springproof::compare {

namespace {

struct JudgeOptions {
  std::vector<std::string> files, settings, clients, methods;
  std::string replay; ///< a recording of interact; empty: none
  ClientBudget budget;
  int meshes = 0;
  std::string out;
  bool json = false;
};

std::vector<Client> clients_of(const JudgeOptions& options) {
  std::vector<Client> clients;
  for (const std::string& argument : options.clients) {
    clients.push_back(client_of(argument));
    const std::string& name = clients.back().name;
    if (name == fem_model || name == springs_model || method_called(name))
      throw cases::InputError("--client: \"" + name + "\" is the name of a row of ours; give another");
    if (std::count_if(clients.begin(), clients.end(), [&](const Client& one) { return one.name == name; }) >
        1)
      throw cases::InputError("--client: two clients are called \"" + name +
                              "\"; give each a name of its own");
  }
  return clients;
}

int run(const JudgeOptions& options) {
  if (n_mpi_ranks() > 1) throw cases::InputError("judge: runs on one rank; start it without mpirun");
  const std::vector<Client> clients = clients_of(options);
  if (clients.empty() && options.methods.empty())
    throw cases::InputError("judge: nothing is to be judged; give --client NAME=COMMAND or --method NAME");
  std::vector<NamedMethod> methods;
  for (const std::string& argument : options.methods) methods.push_back(method_of(argument, options.budget));
  std::vector<Question> questions =
      read_questions(options.files, options.settings, {std::nullopt, options.meshes});
  check_memory(questions);
  questions = with_recording(std::move(questions), options.replay);
  claim_folder(options.out);
  std::vector<JudgedCase> judged;
  for (const Question& question : questions) {
    judged.push_back(judge_clients(question.scene, methods, clients, options.budget, options.meshes));
    if (!options.json) write_judged_text(std::cout, judged.back());
    if (options.out.empty()) continue;
    write_json_file(options.out + "/judged.json", judged_to_json(judged, options.budget));
    write_file(options.out + "/judged.csv", [&](std::ostream& out) { write_judged_csv(out, judged); });
  }
  if (options.json) std::cout << json_text(judged_to_json(judged, options.budget));
  const bool failed =
      std::any_of(judged.begin(), judged.end(), [](const JudgedCase& one) { return one.has_failed(); });
  return failed ? 1 : 0;
}

} // namespace

void add_judge_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<JudgeOptions>(
      program, chosen, "judge",
      "other programs' answers to cases, asked live, beside springs and finite elements", run);
  command->add_option("cases", options->files, "case files (TOML)")->required();
  command->add_option(
      "--client", options->clients,
      "NAME=COMMAND: a program that speaks the protocol, started without a shell, confined; may "
      "be repeated");
  command->add_option(
      "--method", options->methods,
      "NAME[:ITERATIONS[:SUBSTEPS]]: a method of [msm] real_time that steps our springs, or fem.NAME of "
      "[fem] real_time that steps elements; may be repeated");
  ClientBudget& budget = options->budget;
  add_step_options(*command, budget);
  command->add_option("--end", budget.model_time, "time within which a body is to come to rest, s")
      ->check(number_between(1e-6, 1e6))
      ->capture_default_str();
  command->add_option("--seconds", budget.seconds, "wall-clock time of each answer")
      ->check(number_between(0.1, 1e5))
      ->capture_default_str();
  command->add_option("--start-seconds", budget.start_seconds, "wall-clock time of a client's start")
      ->check(number_between(0.1, 1e4))
      ->capture_default_str();
  add_converge_option(*command, options->meshes);
  add_replay_option(*command, options->replay);
  add_set_option(*command, options->settings, "KEY=VALUE of the cases");
  command->add_option("--out", options->out, "folder for judged.json and judged.csv");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
