#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/case/names.hpp"
#include "cases/mesh/read_vtk.hpp"
#include "compare/peers/held_against_case.hpp"
#include "compare/provenance/print.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/ranks.hpp"
#include "msm/problem.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// A file whose ending and name were looked at.
struct ResultFile {
  std::string text;
  bool is_csv;
};

ResultFile read_result_file(const std::string& path) {
  static const std::vector<std::string> endings{".csv", ".vtu", ".vtp", ".vtk", ".vts", ".vtr", ".vti"};
  const std::string ending = std::filesystem::path(path).extension();
  if (std::find(endings.begin(), endings.end(), ending) == endings.end())
    throw cases::InputError(
        fmt::format("{}: displacements must be in a file {} (x,y,z,ux,uy,uz), or of VTK: {}", path,
                    endings.front(), fmt::join(endings.begin() + 1, endings.end(), " ")));
  if (one_line(path) != path)
    throw cases::InputError(one_line(path) + ": the file's name must be one line of UTF-8 text");
  const bool is_csv = ending == ".csv";
  return {is_csv ? cases::read_text_file(path) : cases::read_bytes(path), is_csv};
}

cases::CellCloud cells_of(const std::string& text, const cases::HexMesh& mesh, const std::string& path) try {
  return cases::read_cell_cloud(text, mesh);
} catch (const std::runtime_error& error) {
  throw cases::InputError(fmt::format("{}: cannot be interpolated: {}", path, error.what()));
}

ExternalDisplacements read_interpolated(const cases::HexMesh& mesh, const std::string& path) {
  const auto [text, is_csv] = read_result_file(path);
  if (is_csv)
    throw cases::InputError(path + ": --interpolate needs the results' cells, which a .csv does not have");
  cases::CellCloud cells = cells_of(text, mesh, path);
  std::vector<Eigen::Vector3d> displacement = cells.to_nodes.of(finite_displacements(cells.cloud, path));
  for (std::size_t n = 0; n < displacement.size(); ++n)
    if (!displacement[n].allFinite())
      throw cases::InputError(fmt::format("{}: cannot be interpolated: is not finite at node {}", path, n));
  return {path, std::move(displacement), std::move(cells)};
}

/// A displacement of all nodes of the mesh as an answer, shared by the ranks.
Answer answer_of(const cases::HexMesh& mesh, const std::string& message,
                 const std::function<std::vector<Eigen::Vector3d>()>& displacement) {
  return shared_from_rank_0<Answer>(mesh, [&] {
    Answer answer;
    cases::Solution& solution = answer.solution;
    solution.status = cases::Status::converged;
    solution.message = message;
    solution.displacement = displacement();
    solution.load_reached = 1;
    msm::measure_cells(mesh, solution);
    return answer;
  });
}

/// With the finite elements' displacement there and back, by which the results' loss is estimated.
Interpolated interpolated(const Answer& fem, const cases::HexMesh& mesh, const cases::CellCloud& cells) {
  Interpolated result;
  result.n_points = cells.cloud.points.size();
  const double at_the_surface = same_place(mesh);
  for (const double distance : cells.to_nodes.outside) {
    if (distance <= at_the_surface) continue;
    ++result.n_outside;
    result.largest_distance = std::max(result.largest_distance, distance);
  }
  if (!fem.converged()) return result;
  const cases::Solution whole = gathered(fem.solution);
  result.fem_and_back =
      answer_of(mesh, "", [&] { return cells.to_nodes.of(cells.from_nodes.of(whole.displacement)); });
  return result;
}

} // namespace

std::vector<GivenDisplacement> read_displacements(const std::string& path) {
  const auto [text, is_csv] = read_result_file(path);
  return is_csv ? read_displacement_csv(text, path) : read_displacement_vtk(text, path);
}

std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path, Transfer transfer) {
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
  if (questions.front().scene.definition.dynamics)
    throw cases::InputError("--msm-displacements: displacements have no time, and this case has [dynamics]");
  const cases::HexMesh& mesh = questions.front().scene.mesh;
  if (transfer == Transfer::interpolated) return read_interpolated(mesh, path);
  return ExternalDisplacements{path, match_nodes(mesh, read_displacements(path), path)};
}

Answers with_displacements(Answers answers, const cases::Scene& scene,
                           const ExternalDisplacements& external) {
  const cases::HexMesh& mesh = scene.mesh;
  HeldAgainstCase held = hold_against_case(scene, external.displacement);
  answers.msm = answer_of(mesh, held.message, [&] { return external.displacement; });
  answers.msm_warnings = std::move(held.warnings);
  answers.design.reset();
  answers.msm_source = external.path;
  if (external.cells) answers.interpolated = interpolated(answers.fem, mesh, *external.cells);
  return answers;
}

} // namespace springproof::compare
