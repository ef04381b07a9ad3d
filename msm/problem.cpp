#include "msm/problem.hpp"

#include "cases/mesh/sharing.hpp"
#include "cases/scene/loads.hpp"

#include <algorithm>
#include <utility>

namespace springproof::msm {

namespace {

/// @param factor  returns a motion's factor from the load factor or the time
std::function<const std::vector<cases::NodeVector>&(double)>
moving_supports(const cases::Scene& scene, double (*factor)(const cases::Moved& motion, double at)) {
  if (scene.moved.empty()) return {};
  std::vector<int> nodes;
  for (const auto& [selection, motion] : scene.moved)
    nodes.insert(nodes.end(), selection.nodes.begin(), selection.nodes.end());
  cases::make_set(nodes);
  std::vector<cases::NodeVector> all;
  for (const int node : nodes) all.push_back({node, Eigen::Vector3d::Zero()});
  return [moved = scene.moved, rest = scene.mesh.nodes, nodes, factor,
          displacement = std::move(all)](double at) mutable -> const std::vector<cases::NodeVector>& {
    for (const auto& [selection, motion] : moved)
      for (const int node : selection.nodes) {
        const Eigen::Vector3d by = cases::moved_by(motion, rest[cases::index(node)], factor(motion, at));
        const auto place = std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin();
        for (int a = 0; a < 3; ++a)
          if (motion.components[cases::index(a)]) displacement[cases::index(place)].value[a] = by[a];
      }
    return displacement;
  };
}

/// What acts on the points, gravity among it.
std::vector<cases::NodeVector> loads(const cases::Scene& scene) {
  const std::vector<cases::NodeVector> some = cases::loaded_nodes(scene);
  const Eigen::Vector3d gravity = cases::gravity(scene);
  if (gravity.isZero(0)) return some;
  std::vector<cases::NodeVector> all = cases::weights(cases::point_masses(scene), gravity);
  for (const auto& [node, force] : some) all[cases::index(node)].value += force;
  return all;
}

} // namespace

std::size_t n_unknowns(const Problem& problem) {
  const auto& constrained = problem.is_constrained;
  return static_cast<std::size_t>(std::count(constrained.begin(), constrained.end(), false));
}

Problem make_problem(const cases::Scene& scene) {
  const auto factor = [](const cases::Moved& /*motion*/, double load_factor) { return load_factor; };
  Problem problem{
      scene.mesh, {}, loads(scene), cases::constrained_dofs(scene), moving_supports(scene, factor)};
  if (!scene.definition.tools.empty())
    problem.contact = std::make_shared<mechanics::Contact>(mechanics::tool_sides(scene));
  return problem;
}

Problem make_moving_problem(const cases::Scene& scene) {
  const auto factor = [](const cases::Moved& motion, double time) { return motion.history.at(time); };
  return {scene.mesh, {}, {}, cases::constrained_dofs(scene), moving_supports(scene, factor)};
}

void measure_cells(const cases::Mesh& mesh, cases::Solution& solution) {
  const cases::Sharing* const sharing = solution.sharing.get();
  const auto [own_nodes, cells, nodes] = cases::share_here(mesh, sharing);
  solution.cell_volume.clear();
  for (std::size_t c = cells.begin; c < cells.end; ++c)
    solution.cell_volume.push_back(
        cases::cell_volume(cases::cell_corners(mesh, c, solution.displacement, nodes.begin)));
  solution.inverted_cells = cases::n_inverted(mesh, solution.displacement, sharing);
}

cases::Solution solution_of(const Problem& problem, const mechanics::Equilibrium& equilibrium,
                            Points displacement, std::shared_ptr<const cases::Sharing> sharing) {
  cases::Solution solution = mechanics::to_solution(equilibrium);
  solution.sharing = std::move(sharing);
  solution.displacement = std::move(displacement);
  measure_cells(problem.mesh, solution);
  return solution;
}

} // namespace springproof::msm
