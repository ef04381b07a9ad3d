#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "compare/app/commands.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/fit/fit.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/table/table.hpp"

#include <algorithm>
#include <iostream>

namespace springproof::compare {

namespace {

struct FitOptions {
  FitCases cases;
  std::vector<std::string> free;
  DesignOptions curve; ///< --curve with what its columns are
  std::string data, law, client, out;
  std::string only = "both";
  int n_terms = 1, n_workers = 0;
  bool json = false;
};

std::vector<Fit> fits_of_curve(const FitOptions& options) {
  std::vector<CurveLaw> laws;
  for (const std::string& name : cases::all_names<CurveLaw>())
    if (options.law == name || options.law == "all") laws.push_back(*cases::value_of<CurveLaw>(name));
  const msm::UniaxialCurve curve = measured_curve(options.curve);
  std::vector<Fit> fits;
  for (const CurveLaw law : laws)
    fits.push_back(fit_curve(curve, law, options.n_terms, options.curve.curve_file));
  return fits;
}

std::vector<Fit> fits_of_cases(const FitOptions& options) {
  const bool has_limit = options.data == "limit";
  if (has_limit && options.only == cases::name_of(cases::Side::fem))
    throw cases::InputError("--to limit: the finite elements are the data; leave --only fem out");
  const AnswerQuestions answer = [&](const std::vector<Question>& questions) {
    return answer_all(questions, FinishedCases("", {}), solve_fem, {options.n_workers});
  };
  const FitData data = has_limit
                           ? limits_as_data(options.cases, answer)
                           : read_fit_data(cases::read_text_file(options.data), options.data, options.cases);
  if (!options.client.empty()) {
    std::vector<Question> questions;
    for (const FitState& state : data.states)
      questions.push_back({scene_of(options.cases, state), Request{cases::Side::msm}});
    return {fit_cases(options.cases, data, options.data, options.free, cases::Side::msm, answer,
                      read_client(questions, options.client))};
  }
  std::vector<Fit> fits;
  for (const cases::Side side : {cases::Side::fem, cases::Side::msm})
    if (options.only == cases::name_of(side) ||
        (options.only == "both" && !(has_limit && side == cases::Side::fem)))
      fits.push_back(fit_cases(options.cases, data, options.data, options.free, side, answer));
  return fits;
}

int run(const FitOptions& options) {
  if (n_mpi_ranks() > 1) throw cases::InputError("fit: runs on one rank; start it without mpirun");
  const bool is_curve = !options.curve.curve_file.empty();
  if (is_curve == !options.cases.files.empty())
    throw cases::InputError("fit: give case files with --to DATA, or --curve FILE with --law");
  const DesignOptions& columns = options.curve;
  if (!is_curve &&
      !(columns.curve_strain.empty() && columns.curve_stress.empty() && columns.curve_unit.empty()))
    throw cases::InputError("fit: --strain, --stress and --unit are of the columns of --curve");
  if (options.n_terms > 1 && (options.law == "neo_hookean" || options.law == "mooney_rivlin"))
    throw cases::InputError(fmt::format("fit: --terms: {} has none to choose; leave it out", options.law));
  if (!is_curve && options.data.empty())
    throw cases::InputError("fit: --to is missing, must be a CSV file of data, or \"limit\"");
  claim_folder(options.out);
  const std::vector<Fit> fits = is_curve ? fits_of_curve(options) : fits_of_cases(options);
  if (options.json)
    std::cout << json_text(fits_to_json(fits));
  else
    for (const Fit& fit : fits) {
      if (&fit != &fits.front()) std::cout << '\n';
      write_fit_text(std::cout, fit, !is_curve || fits.size() == 1);
    }
  if (!options.out.empty()) {
    write_json_file(options.out + "/fit.json", fits_to_json(fits));
    write_file(options.out + "/fit.csv", [&](std::ostream& out) { write_fit_csv(out, fits); });
  }
  return std::all_of(fits.begin(), fits.end(), [](const Fit& fit) { return fit.found.has_values(); }) ? 0 : 1;
}

} // namespace

void add_fit_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<FitOptions>(
      program, chosen, "fit",
      "parameters of springs and finite elements from data, with what the data leave open and the error on "
      "data not fitted",
      run);
  CLI::Option* files = command->add_option("cases", options->cases.files, "case files (TOML)");
  CLI::Option* to =
      command->add_option("--to", options->data,
                          "data, CSV: measures of the cases or markers; or \"limit\" of the finite elements");
  CLI::Option* held_out = command
                              ->add_option("--hold-out", options->cases.held_out,
                                           "a case whose data are predicted, not fitted; may be repeated")
                              ->allow_extra_args(false);
  CLI::Option* free =
      command
          ->add_option("--free", options->free,
                       "KEY or KEY=START of the cases to be fitted; may be repeated; without it the moduli")
          ->allow_extra_args(false);
  CLI::Option* only = command->add_option("--only", options->only, "fit one model alone")
                          ->check(CLI::IsMember({"fem", "msm", "both"}))
                          ->capture_default_str();
  CLI::Option* client =
      command
          ->add_option("--client", options->client,
                       "NAME=COMMAND: a program whose parameters are fitted, without derivatives; {NAME} "
                       "in it is the value of --free client.NAME=START")
          ->excludes(only);
  CLI::Option* set = add_set_option(*command, options->cases.settings, "KEY=VALUE of the cases");
  CLI::Option* curve = add_curve_options(*command, options->curve);
  CLI::Option* law =
      command->add_option("--law", options->law, "law that the curve is fitted by, or all")->check([] {
        std::vector<std::string> names = cases::all_names<CurveLaw>();
        names.emplace_back("all");
        return CLI::IsMember(names);
      }());
  command->add_option("--terms", options->n_terms, "terms of yeoh and ogden")
      ->check(CLI::Range(1, 3))
      ->capture_default_str()
      ->needs(law);
  curve->needs(law);
  law->needs(curve);
  for (CLI::Option* option : {files, to, held_out, free, only, client, set}) option->excludes(curve);
  add_workers_option(*command, options->n_workers);
  command->add_option("--out", options->out, "folder for fit.json and fit.csv");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
