#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/vtk.hpp"
#include "msm/problem.hpp"

#include <fmt/format.h>
#include <utility>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

std::string shown(const Vector3d& point) {
  return fmt::format("({:.10g}, {:.10g}, {:.10g})", point.x(), point.y(), point.z());
}

} // namespace

std::vector<Vector3d> match_nodes(const cases::HexMesh& mesh, const std::vector<GivenDisplacement>& given,
                                  const std::string& path) {
  std::vector<Vector3d> positions, displacement;
  for (const GivenDisplacement& next : given) positions.push_back(next.position);
  const std::vector<std::size_t> nearest = cases::vtk().nearest_points(mesh.nodes, positions);
  std::vector<const GivenDisplacement*> of_node(mesh.nodes.size(), nullptr);
  for (std::size_t g = 0; g < given.size(); ++g) {
    const GivenDisplacement& next = given[g];
    const Vector3d& node = mesh.nodes[nearest[g]];
    const double tolerance = same_place + next.rounding;
    if (!((node - next.position).norm() <= tolerance))
      throw cases::InputError(
          fmt::format("{}: no node of the case's mesh lies within {:g} mm of {}; the nearest is {}",
                      next.where, tolerance, shown(next.position), shown(node)));
    if (const GivenDisplacement* known = std::exchange(of_node[nearest[g]], &next))
      throw cases::InputError(fmt::format("{}: the node {} is given twice, first in {}", next.where,
                                          shown(next.position), known->where));
  }
  for (std::size_t n = 0; n < of_node.size(); ++n) {
    if (!of_node[n])
      throw cases::InputError(
          fmt::format("{}: has {} of the {} nodes of the case's mesh, must have all: {} is missing", path,
                      given.size(), mesh.nodes.size(), shown(mesh.nodes[n])));
    displacement.push_back(of_node[n]->displacement);
  }
  return displacement;
}

std::optional<ExternalDisplacements> read_external(const std::vector<Question>& questions,
                                                   const std::string& path) {
  if (path.empty()) return std::nullopt;
  if (questions.size() != 1)
    throw cases::InputError(
        fmt::format("--msm-displacements: belongs to one case, {} are given", questions.size()));
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
  solution.displacement = external.displacement;
  solution.load_reached = 1;
  msm::measure_cells(mesh, solution);
  return answers;
}

} // namespace springproof::compare
