#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/mesh/sharing.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "mechanics/ranks/share_out.hpp"
#include "msm/problem.hpp"

#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

std::vector<GivenDisplacement> read_displacements(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension();
  if (ending != ".csv" && ending != ".vtu")
    throw cases::InputError(
        fmt::format("{}: displacements must be in a file .csv (x,y,z,ux,uy,uz) or .vtu", path));
  if (one_line(path) != path)
    throw cases::InputError(one_line(path) + ": the file's name must be one line of UTF-8 text");
  const std::string text = read_file(path);
  return ending == ".csv" ? read_displacement_csv(text, path) : read_displacement_vtu(text, path);
}

std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path) {
  if (path.empty()) return std::nullopt;
  if (questions.size() != 1)
    throw cases::InputError(
        fmt::format("--msm-displacements: belongs to one case, {} are given", questions.size()));
  for (const cases::Measure& measure : questions.front().scene.definition.measures)
    if (cases::is_of_fields(measure.kind))
      throw cases::InputError(measure.where,
                              fmt::format("kind is \"{}\", which displacements alone do not tell: leave it "
                                          "out beside --msm-displacements",
                                          cases::name_of(measure.kind)));
  return ExternalDisplacements{path,
                               match_nodes(questions.front().scene.mesh, read_displacements(path), path)};
}

Answers with_displacements(Answers answers, const cases::HexMesh& mesh,
                           const ExternalDisplacements& external) {
  answers.msm = {};
  answers.design.reset();
  answers.msm_source = external.path;
  cases::Solution& solution = answers.msm.solution;
  solution.status = cases::Status::converged;
  solution.message = "displacements of " + external.path;
  solution.sharing = mechanics::share_out(mesh, MPI_COMM_WORLD);
  const cases::Range here = cases::share_here(mesh, solution.sharing.get()).nodes;
  const auto first = external.displacement.begin();
  solution.displacement.assign(first + std::ptrdiff_t(here.begin), first + std::ptrdiff_t(here.end));
  solution.load_reached = 1;
  msm::measure_cells(mesh, solution);
  return answers;
}

} // namespace springproof::compare
