#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace springproof::compare {

namespace {

using Eigen::Vector3d;

std::string shown(const Vector3d& point) {
  return fmt::format("({:.10g}, {:.10g}, {:.10g})", point.x(), point.y(), point.z());
}

/// Nodes by the box of space that they lie in. The boxes are wider than the tolerance, so that a node within
/// it lies in the point's own box or in a neighbour.
class NodesByPlace {
 public:
  explicit NodesByPlace(const std::vector<Vector3d>& nodes) : nodes_(nodes) {
    for (std::size_t n = 0; n < nodes.size(); ++n) boxes_.emplace(box_of(nodes[n], {0, 0, 0}), n);
  }

  std::optional<std::size_t> find(const Vector3d& point) const {
    for (int i = 0; i < 27; ++i) {
      const int k = (i + 13) % 27; // the point's own box first
      const auto range = boxes_.equal_range(box_of(point, {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1}));
      for (auto it = range.first; it != range.second; ++it)
        if ((nodes_[it->second] - point).norm() <= same_place) return it->second;
    }
    return std::nullopt;
  }

 private:
  using Box = std::array<double, 3>;
  static Box box_of(const Vector3d& point, const std::array<int, 3>& neighbour) {
    constexpr double width = 4 * same_place;
    Box box;
    for (int a = 0; a < 3; ++a)
      box[static_cast<std::size_t>(a)] =
          std::floor(point[a] / width) + neighbour[static_cast<std::size_t>(a)];
    return box;
  }
  const std::vector<Vector3d>& nodes_;
  std::multimap<Box, std::size_t> boxes_;
};

Vector3d nearest(const std::vector<Vector3d>& nodes, const Vector3d& point) {
  Vector3d best = nodes.front();
  for (const Vector3d& node : nodes)
    if ((node - point).squaredNorm() < (best - point).squaredNorm()) best = node;
  return best;
}

} // namespace

std::vector<Vector3d> match_nodes(const cases::HexMesh& mesh, const std::vector<GivenDisplacement>& given,
                                  const std::string& path) {
  const NodesByPlace places(mesh.nodes);
  std::vector<const GivenDisplacement*> of_node(mesh.nodes.size(), nullptr);
  for (const GivenDisplacement& next : given) {
    const auto node = places.find(next.position);
    if (!node)
      throw cases::InputError(fmt::format(
          "{}: no node of the case's mesh lies within {:g} mm of {}; the nearest is {}", next.where,
          same_place, shown(next.position), shown(nearest(mesh.nodes, next.position))));
    if (of_node[*node])
      throw cases::InputError(fmt::format("{}: the node {} is given twice, first in {}", next.where,
                                          shown(next.position), of_node[*node]->where));
    of_node[*node] = &next;
  }
  std::vector<Vector3d> displacement;
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
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto vertices = cases::cell_vertices(mesh, c, solution.displacement);
    solution.cell_volume.push_back(cases::cell_volume(vertices));
    if (cases::smallest_corner_jacobian(vertices) <= 0) ++solution.inverted_cells;
  }
  return answers;
}

} // namespace springproof::compare
