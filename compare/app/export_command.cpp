#include "compare/app/commands.hpp"

#include "cases/mesh/vtk_functions.hpp"
#include "compare/client/judge.hpp"
#include "compare/export/export_springs.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/springs.hpp"

#include <iostream>

namespace springproof::compare {

namespace {

struct ExportOptions {
  std::string file, target, out;
  std::vector<std::string> settings;
};

/// Errors of a case's springs of another design, from its finite elements on the same mesh.
std::string error_of(const ExportOptions& options, const std::string& design) {
  const auto no_answer = [](const std::string& why) {
    return ", which do not answer this case: " + one_line(why);
  };
  std::vector<std::string> settings = options.settings;
  settings.push_back("msm.design=" + design);
  try {
    const cases::Scene scene = read_questions({options.file}, settings, {}).front().scene;
    if (scene.definition.measures.empty()) return "";
    const JudgedRow springs = Judge(scene, 0).own({}).rows.back();
    if (!springs.worst) return no_answer(springs.failure);
    return fmt::format(", which err by {:.3g} % on this case (its worst measure, {})", *springs.worst,
                       one_line(springs.worst_at));
  } catch (const cases::InputError& error) { // a key that belongs to the other design, too little memory
    return no_answer(error.what());
  }
}

int export_case(const ExportOptions& options) {
  Request request;
  request.only = cases::Side::msm;
  const cases::Scene scene = read_questions({options.file}, options.settings, request).front().scene;
  const ExportTarget target = *cases::value_of<ExportTarget>(options.target);
  const std::string& name = scene.definition.name;
  const msm::Problem problem = exported_problem(scene);
  const std::optional<ExportedMotion> motion = exported_motion(scene);
  if (target == ExportTarget::vtu) cases::check_has_vtk();
  check_expressible(target, name, problem, motion, // before there is a folder
                    [&](const std::string& design) { return error_of(options, design); });
  claim_folder(options.out);
  if (mpi_rank() != 0) return 0;
  const std::vector<std::string> said =
      export_springs(options.out, target, name, problem, exported_body(scene), motion);
  for (const std::string& line : said) write_paragraph(std::cout, line, "", "  ");
  for (const std::string& warning : design_for(scene).warnings)
    write_paragraph(std::cout, warning, "warning: ", "  ");
  return 0;
}

} // namespace

void add_export_command(CLI::App& program, Action& chosen) {
  const auto [command, options] = add_command<ExportOptions>(
      program, chosen, "export", "the designed springs of a case as an explicit list, for other programs",
      export_case);
  command->add_option("case", options->file, "case file (TOML)")->required();
  command->add_option("--to", options->target, "what the springs are written for")
      ->required()
      ->check(CLI::IsMember(cases::all_names<ExportTarget>()));
  command->add_option("--out", options->out, "folder for the files")->required();
  add_set_option(*command, options->settings, "override a key: msm.design=moduli");
}

} // namespace springproof::compare
