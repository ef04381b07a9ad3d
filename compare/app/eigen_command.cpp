#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "compare/app/commands.hpp"
#include "compare/modes/modes.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/table/json.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iostream>

namespace springproof::compare {

namespace {

struct EigenOptions {
  DesignOptions design;
  std::string vibrating;            ///< a case file; empty: eigenspaces of a cell
  std::vector<std::string> designs; ///< designs of its springs; empty: its own
  int n_modes = 20;
  int body_cells = 0;
  std::string out;
  bool json = false;
};

/// The body whose modes are compared: the case's, or a cube of cells.
std::optional<cases::Mesh> body_of(const EigenOptions& options, const msm::CellVertices& cell) {
  const std::string& file = options.design.case_file;
  if (!file.empty()) {
    cases::Mesh mesh = make_scene_within_memory(cases::read_case(file, options.design.settings)).mesh;
    if (!mesh.grid) throw cases::InputError(file + ": free modes are for bodies of equal cells");
    return mesh;
  }
  if (options.body_cells == 0) return std::nullopt;
  const int n = options.body_cells;
  return cases::make_box_mesh(Eigen::Vector3d::Constant(n * msm::cube_edge(cell)), {{n, n, n}});
}

/// A document's start, with what overrides the case.
nlohmann::ordered_json document_of(const EigenOptions& options) {
  nlohmann::ordered_json document{{"schema", 1}};
  if (!options.design.settings.empty()) document["settings"] = options.design.settings;
  return document;
}

/// The lowest vibrations of a case's body.
int run_vibrations(const EigenOptions& options) {
  const cases::Scene scene = make_scene_within_memory(
      cases::read_case(options.vibrating, options.design.settings, cases::Purpose::vibrations));
  const std::vector<cases::Design> designs = designs_of(options.designs, scene.definition);
  const bool is_network = !cases::has_cells(scene.definition.body);
  if (!options.designs.empty())
    cases::refuse_network(scene.definition, "--designs", "leave it out for the network's own springs");
  check_memory(options.vibrating,
               is_network ? std::vector{estimate_free_springs(size_of(scene))}
                          : estimate_vibrations(size_of(scene)),
               memory_limit());
  if (!options.out.empty()) cases::check_has_vtk(); // for the .vtu
  claim_folder(options.out);
  if (mpi_rank() != 0) return 0;
  const VibrationStudy study = study_vibrations(scene, designs, options.n_modes);
  if (options.json) {
    nlohmann::ordered_json document = document_of(options);
    document.update(vibrations_to_json(study));
    std::cout << json_text(document);
  } else {
    write_vibrations_text(std::cout, study);
  }
  if (!options.out.empty()) write_vibrations_files(options.out, study, scene.mesh);
  // A design that is refused among others is a row with its reason.
  const bool has_answer = std::any_of(study.designs.begin(), study.designs.end(),
                                      [](const DesignVibrations& design) { return design.refusal.empty(); });
  return has_answer ? 0 : 1;
}

int run(const EigenOptions& asked) {
  EigenOptions options = asked;
  if (!options.vibrating.empty()) return run_vibrations(options);
  if (options.design.case_file.empty() && n_materials(options.design) == 0) options.design.youngs_modulus = 1;
  if (options.design.case_file.empty() && options.design.method.empty())
    options.design.method =
        cases::name_of(cases::Design::linear_method); // whose eigenspaces the thesis prints
  const msm::DesignRequest request = request_from(options.design);
  cases::LinearElastic material = msm::small_strain_material(request.material);
  material.poissons_ratio = request.options.poissons_ratio.value_or(material.poissons_ratio);
  if (!(material.poissons_ratio < 0.5))
    throw cases::InputError(
        "eigenspaces: K_FEM is infinite at nu = 0.5; give a material with nu < 0.5, or --poisson");
  const msm::CellMatrix fem = request.element_stiffness(material);
  const msm::DesignResult design = msm::design(request);
  if (design.springs.terms())
    throw cases::InputError(
        fmt::format("eigenspaces: design = \"{}\" has no single cell that the body repeats; "
                    "take one of four stiffnesses",
                    cases::name_of(request.options.design)));
  const msm::CellMatrix msm = msm::cell_stiffness_matrix(request.cell, design.stiffness);
  if (!options.out.empty()) cases::check_has_vtk(); // for the .vtu
  claim_folder(options.out);
  if (mpi_rank() != 0) return 0;
  const EigenspaceAnalysis analysis = analyse_eigenspaces(mechanics::spectrum(fem), mechanics::spectrum(msm));
  const std::optional<cases::Mesh> body = body_of(options, request.cell);
  std::optional<FreeBodyModes> modes;
  if (body) modes = free_body_modes(assemble(*body, fem), assemble(*body, msm), options.n_modes);
  if (options.json) {
    nlohmann::ordered_json document = document_of(options);
    document["poissons_ratio"] = material.poissons_ratio;
    document.update(eigenspaces_to_json(analysis));
    if (modes) document["free_body"] = free_modes_to_json(*modes);
    std::cout << json_text(document);
  } else {
    write_eigenspaces_text(std::cout, analysis);
    if (modes) write_free_modes_text(std::cout, *modes);
  }
  if (options.out.empty()) return 0;
  write_eigenspaces_files(options.out, analysis, request.cell);
  if (modes) write_free_modes_files(options.out, *modes, *body);
  return 0;
}

} // namespace

void add_eigen_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<EigenOptions>(
      program, chosen, "eigen",
      "the lowest vibrations of a case in both models; without a case, eigenspaces of a cell's two "
      "stiffness matrices, and the modes of a whole body",
      run);
  options->design.edge = 2; // with E = 1: the thesis's cell, whose eigenvalues Table 4.2 prints
  add_design_options(*command, options->design);
  CLI::Option* cell = command->get_option("--case");
  CLI::Option* vibrating =
      command->add_option("case", options->vibrating, "case file (TOML) whose material has a density")
          ->excludes(cell);
  add_designs_option(*command, options->designs, "springs of these designs (a,b,c or all)")->needs(vibrating);
  command
      ->add_option("--body", options->body_cells, "also the lowest modes of a free cube of N x N x N cells")
      ->check(CLI::Range(1, 40));
  command->add_option("--modes", options->n_modes, "how many modes of the body")
      ->check(CLI::Range(1, 200))
      ->capture_default_str();
  command->add_option("--out", options->out,
                      "folder for the dot diagram, mode shapes, their pictures and tables");
  add_json_option(*command, options->json);
}

} // namespace springproof::compare
