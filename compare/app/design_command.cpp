#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/app/commands.hpp"
#include "compare/client/for_engine.hpp"
#include "compare/cube/write_design.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/study/on_mesh.hpp"
#include "compare/table/json.hpp"
#include "msm/design/uniaxial.hpp"

#include <algorithm>
#include <iostream>

namespace springproof::compare {

namespace {

struct CommandOptions {
  DesignOptions design;
  std::string body;                 ///< a case file; empty: stiffnesses of a cell
  std::vector<std::string> designs; ///< designs of its springs; empty: its own
  std::string engine, client;       ///< numbers for an engine; the client that runs it, NAME=COMMAND
  double density = 1000;            ///< kg/m³
  ClientBudget budget;
  bool compare = false, pareto = false, measure = false, json = false;
  std::string out;
  bool has_many() const { return compare || pareto; }
};

Json to_json(const CommandOptions& options, const msm::DesignRequest& request,
             const std::vector<DesignAttempt>& attempts) {
  Json document{{"schema", 1}};
  if (!options.design.settings.empty()) document["settings"] = options.design.settings;
  if (!options.has_many())
    document.update(attempt_to_json(attempts.front()));
  else
    for (const DesignAttempt& a : attempts) document["methods"].push_back(attempt_to_json(a));
  if (options.compare && options.measure) {
    const DesignAttempt* best = recommended(attempts);
    document["recommended"] = best ? Json(best->name) : Json(nullptr);
    document["advice"] = recommendation_text(attempts, request);
  }
  return document;
}

void write_nonlinear_figures(const std::string& folder, const msm::DesignRequest& request,
                             const msm::CellStiffness& design) {
  const double edge = msm::cube_edge(request.cell);
  const msm::UniaxialCurve reference = msm::uniaxial_reference(request);
  plot_uniaxial(folder, "uniaxial", design, edge, reference);
  plot_contributions(folder, "contributions", {{"", design, edge, reference.axial_strain}});
  plot_incompressible_family(folder);
  std::vector<msm::CellStiffness> others;
  // The stiffnesses that the thesis prints for its Ogden reference (eq. 5.12), of a 1 mm cell.
  if (std::holds_alternative<cases::Ogden>(request.material))
    others.push_back({edge * 0.014, edge * 0.017, edge * 0.063, 0});
  plot_valley(folder, msm::nonlinear_method(reference, edge).stiffness, edge, reference, others);
}

/// Plots the designs whose lattices have closed forms.
void write_stress_strain(const std::string& folder, const msm::DesignRequest& request,
                         const std::vector<DesignAttempt>& attempts) {
  const double edge = msm::cube_edge(request.cell);
  std::vector<NamedSprings> springs;
  for (const DesignAttempt& a : attempts)
    if (a.design && a.design->is_of_four_stiffnesses()) springs.push_back({a.name, a.design->stiffness});
  if (edge > 0 && !springs.empty()) plot_stress_strain(folder, request.material, springs, edge);
}

void write_files(const CommandOptions& options, const msm::DesignRequest& request,
                 const std::vector<DesignAttempt>& attempts) {
  write_file(options.out + "/design.json",
             [&](std::ostream& out) { out << json_text(to_json(options, request, attempts)); });
  if (options.pareto && options.measure) plot_pareto_front(options.out, attempts);
  if (options.compare) write_stress_strain(options.out, request, attempts);
  if (options.has_many()) return;
  if (request.options.design == cases::Design::linear_method)
    plot_linear_method(options.out, *cases::value_of<cases::Element>(options.design.element));
  if (request.options.design == cases::Design::nonlinear_method)
    write_nonlinear_figures(options.out, request, attempts.front().design->stiffness);
}

/// Whether a design was made, and when measured a load set solved; a refused one is a row with its reason.
bool has_answer(const CommandOptions& options, const std::vector<DesignAttempt>& attempts) {
  return std::any_of(attempts.begin(), attempts.end(), [&](const DesignAttempt& a) {
    return a.design && (!options.measure || a.cube->small.worst || a.cube->large.worst);
  });
}

/// What springs can do on a case's own mesh.
int run_on_mesh(const CommandOptions& options) {
  const cases::Scene scene =
      make_scene_within_memory(cases::read_case(options.body, options.design.settings));
  cases::refuse_network(scene.definition, "designs", "export --to csv writes its springs");
  if (is_matrix_made(scene.mesh))
    check_memory(options.body, {estimate_free_springs(size_of(scene))}, memory_limit());
  claim_folder(options.out);
  if (mpi_rank() != 0) return 0;
  const SpringsOnMesh study =
      study_on_mesh(scene, options.designs.empty() ? std::vector<cases::Design>()
                                                   : designs_of(options.designs, scene.definition));
  Json document{{"schema", 1}};
  if (!options.design.settings.empty()) document["settings"] = options.design.settings;
  document.update(on_mesh_to_json(study));
  if (options.json)
    std::cout << json_text(document);
  else
    write_on_mesh_text(std::cout, study);
  if (!options.out.empty())
    write_file(options.out + "/design.json", [&](std::ostream& out) { out << json_text(document); });
  // A design that is refused among others is a row with its reason.
  return std::any_of(study.designs.begin(), study.designs.end(),
                     [](const DesignOnMesh& design) { return design.refusal.empty(); })
             ? 0
             : 1;
}

/// The numbers that an engine takes, and the error to expect of it.
int run_for_engine(const CommandOptions& options, const msm::DesignRequest& request) {
  if (n_mpi_ranks() > 1) throw cases::InputError("design: --for runs on one rank; start it without mpirun");
  EngineRequest engine{*cases::value_of<Engine>(options.engine), request, !options.design.method.empty(),
                       options.density, options.budget};
  if (!options.client.empty()) engine.client = client_of(options.client);
  const EngineDesign found = design_for_engine(engine);
  if (options.json)
    std::cout << json_text(engine_design_to_json(found));
  else
    write_engine_design_text(std::cout, found);
  return found.has_failed() ? 1 : 0;
}

int run(const CommandOptions& options) {
  if (!options.body.empty()) return run_on_mesh(options);
  const msm::DesignRequest request = request_from(options.design);
  if (!options.engine.empty()) return run_for_engine(options, request);
  claim_folder(options.out);
  std::vector<DesignAttempt> attempts = options.pareto    ? attempt_springs(request)
                                        : options.compare ? attempt_all(request)
                                                          : std::vector{attempt_one(request)};
  if (options.measure) measure_on_cube(attempts, request);
  if (mpi_rank() != 0) return 0;
  if (options.json)
    std::cout << json_text(to_json(options, request, attempts));
  else if (options.has_many())
    write_comparison_text(std::cout, attempts);
  else
    write_design_text(std::cout, attempts.front());
  if (options.compare && !options.json) {
    std::cout << '\n';
    write_paragraph(std::cout, options.measure
                                   ? recommendation_text(attempts, request)
                                   : "Which one to use, by its errors on the thesis's cube: --measure.");
  }
  if (!options.out.empty()) write_files(options, request, attempts);
  return has_answer(options, attempts) ? 0 : 1;
}

} // namespace

void add_design_command(CLI::App& program, Action& chosen) {
  const auto [command, options] =
      add_command<CommandOptions>(program, chosen, "design",
                                  "stiffnesses of a cell for a material, and the lattice's moduli; of a "
                                  "case, what its springs can do on its own mesh",
                                  run);
  add_design_options(*command, options->design);
  command->add_flag("--compare", options->compare, "every method side by side");
  command->add_flag("--pareto", options->pareto, "springs alone: accuracy against stability (with --measure)")
      ->excludes("--compare");
  command->add_flag("--measure", options->measure,
                    "the errors of the thesis's cube with these designs (solves both models)");
  CLI::Option* engine = command
                            ->add_option("--for", options->engine,
                                         "the numbers that an engine takes, and its error on a beam of these "
                                         "cells, found by running it")
                            ->check(CLI::IsMember(cases::all_names<Engine>()));
  for (const char* other : {"--compare", "--pareto", "--measure"})
    engine->excludes(command->get_option(other));
  command->add_option("--client", options->client, "NAME=COMMAND that runs the engine, in place of its own")
      ->needs(engine);
  command->add_option("--density", options->density, "density of the body, kg/m^3")
      ->check(number_between(1e-3, 1e6))
      ->capture_default_str()
      ->needs(engine);
  for (CLI::Option* option : add_step_options(*command, options->budget)) option->needs(engine);
  command->add_option("--out", options->out, "folder for design.json and the method's figures")
      ->excludes(engine);
  CLI::Option* body = command->add_option(
      "case", options->body, "case file (TOML): what springs can do on its mesh, before a solve");
  for (CLI::Option* option : command->get_options()) // which are of a single cell
    if (option != body && option != command->get_help_ptr() && !option->check_lname("set") &&
        !option->check_lname("out"))
      body->excludes(option);
  add_designs_option(*command, options->designs, "springs of these designs (a,b,c or all)")->needs(body);
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
