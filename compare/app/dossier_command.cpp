#include "cases/case/error.hpp"
#include "compare/app/commands.hpp"
#include "compare/app/typed_command.hpp"
#include "compare/dossier/dossier.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/report/pages.hpp"
#include "compare/table/table.hpp"

#include <iostream>

namespace springproof::compare {

namespace {

struct DossierOptions {
  DossierRequest request;
  std::string out;
  int n_workers = 0;
  bool json = false;
};

int run(const DossierOptions& options) {
  if (n_mpi_ranks() > 1) throw cases::InputError("dossier: runs on one rank; start it without mpirun");
  DossierRequest request = options.request;
  for (const char* folder : {"gates", "verification"})
    for (const auto& [name, file] : case_files_in(folder)) request.own_files.push_back(file);
  const FinishedCases kept(options.out, {}, FileNames::of_questions), not_kept("", {});
  const auto answer_with = [&options](const FinishedCases& finished) {
    return [&options, &finished](const std::vector<Question>& questions) {
      return answer_all(questions, finished, solve_fem, {options.n_workers});
    };
  };
  const Dossier dossier = make_dossier(request, answer_with(kept), answer_with(not_kept));
  const Json document = dossier_to_json(dossier);
  write_json_file(options.out + "/dossier.json", document);
  write_dossier_page(options.out, document, {typed_command()});
  if (options.json)
    std::cout << json_text(document);
  else {
    write_dossier_text(std::cout, document);
    std::cout << "files    " << options.out << "/dossier.html, dossier.json\n";
  }
  return dossier.is_sound() ? 0 : 1;
}

} // namespace

void add_dossier_command(CLI::App& program, Action& chosen) {
  const auto [command, options] =
      add_command<DossierOptions>(program, chosen, "dossier",
                                  "why a simulation can be believed, how far, and what nobody has shown: one "
                                  "page, with a gate behind each "
                                  "number or none",
                                  run);
  DossierRequest& request = options->request;
  command->add_option("case", request.cases.files, "case files (TOML)")->required();
  command->add_option("--out", options->out, "folder for dossier.html and dossier.json")->required();
  add_set_option(*command, request.cases.settings, "KEY=VALUE of the cases");
  add_converge_option(*command, request.meshes);
  command->add_option("--measured", request.measured, "measured data, CSV, as fit takes them with --to");
  command
      ->add_option("--uncertain", request.uncertain,
                   "KEY=SIGMA: a key of the cases and its standard uncertainty; may be repeated")
      ->allow_extra_args(false);
  command
      ->add_option("--peer", request.peers,
                   "ask this program about the cases too: ccx, getfem; may be repeated")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"ccx", "getfem"}));
  command->add_option("--question", request.context.question, "what the simulation is to answer");
  command->add_option("--role", request.context.role,
                      "how much the decision rests on it, beside other evidence");
  command->add_option("--consequence", request.context.consequence, "what a wrong answer would do");
  add_workers_option(*command, options->n_workers);
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
