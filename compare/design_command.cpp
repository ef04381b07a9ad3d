#include "cases/names.hpp"
#include "compare/atomic_file.hpp"
#include "compare/commands.hpp"
#include "compare/design_options.hpp"
#include "compare/write_design.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>
#include <iostream>
#include <memory>
#include <mpi.h>
#include <nlohmann/json.hpp>

namespace compare {

namespace {

using Json = nlohmann::ordered_json;

struct CommandOptions {
  DesignOptions design;
  bool compare = false;
  bool json = false;
};

/// A method's answer to the request, or why it has none.
struct Attempt {
  std::string method;
  std::optional<msm::DesignResult> design;
  std::string refusal;
};

Attempt attempt(msm::DesignRequest request, cases::Design method) {
  request.options.design = method;
  try {
    return {cases::name_of(method), msm::design(request), ""};
  } catch (const cases::InputError& error) {
    return {cases::name_of(method), std::nullopt, error.what()};
  } catch (const cases::SolveError& error) {
    return {cases::name_of(method), std::nullopt, error.what()};
  }
}

std::vector<Attempt> attempt_all(const msm::DesignRequest& request) {
  std::vector<Attempt> attempts;
  for (const auto& [method, name] : cases::names<cases::Design>())
    if (method != cases::Design::given) attempts.push_back(attempt(request, method));
  return attempts;
}

void write_comparison(const std::vector<Attempt>& attempts) {
  fmt::print(std::cout, "{:<17}{:>9}{:>9}{:>9}{:>10}{:>10}{:>9}{:>8}{:>9}{:>12}\n", "method", "k_e N/m",
             "k_f", "k_d", "k_v MPa", "E MPa", "nu", "G MPa", "Zener", "residual");
  for (const Attempt& a : attempts) {
    if (!a.design) {
      fmt::print(std::cout, "{:<17}refused: {}\n", a.method, a.refusal);
      continue;
    }
    const msm::CellStiffness& k = a.design->stiffness;
    const msm::LatticeModuli& m = a.design->moduli;
    fmt::print(std::cout, "{:<17}{:>9.4g}{:>9.4g}{:>9.4g}{:>10.4g}{:>10.4g}{:>9.4f}{:>8.4f}{:>9.3f}{:>12}\n",
               a.method, 1e3 * k.edge, 1e3 * k.face_diagonal, 1e3 * k.internal_diagonal, k.volume,
               m.youngs_modulus, m.poissons_ratio, m.shear_modulus, m.zener,
               a.design->residual ? fmt::format("{:.4g}", *a.design->residual) : "-");
    for (const std::string& warning : a.design->warnings) fmt::print(std::cout, "  WARNING: {}\n", warning);
  }
}

Json to_json(const std::vector<Attempt>& attempts) {
  Json methods = Json::array();
  for (const Attempt& a : attempts)
    methods.push_back(a.design ? design_to_json(a.method, *a.design)
                               : Json{{"method", a.method}, {"refused", a.refusal}});
  return {{"schema", 1}, {"methods", methods}};
}

int run(const CommandOptions& options) {
  const msm::DesignRequest request = request_from(options.design);
  const std::string method = cases::name_of(request.options.design);
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank != 0) return 0;
  if (options.compare) {
    const std::vector<Attempt> attempts = attempt_all(request);
    if (options.json)
      std::cout << to_json(attempts).dump(2) << '\n';
    else
      write_comparison(attempts);
    return 0;
  }
  const msm::DesignResult design = msm::design(request);
  if (options.json) {
    Json document{{"schema", 1}};
    document.update(design_to_json(method, design));
    std::cout << document.dump(2) << '\n';
  } else {
    write_design_text(std::cout, method, design);
  }
  return 0;
}

} // namespace

void add_design_command(CLI::App& program, Action& chosen) {
  auto options = std::make_shared<CommandOptions>();
  CLI::App* command =
      program.add_subcommand("design", "stiffnesses of a cell for a material, and the lattice's moduli");
  add_design_options(*command, options->design);
  command->add_flag("--compare", options->compare, "every method side by side");
  command->add_flag("--json", options->json, "one JSON document on standard output, and nothing else there");
  command->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

} // namespace compare
