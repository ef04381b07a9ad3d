#include "msm/problem.hpp"

namespace springproof::msm {

namespace {

std::function<Points(double)> moving_supports(const cases::Scene& scene) {
  if (scene.moved.empty()) return {};
  return [moved = scene.moved, rest = scene.mesh.nodes](double load_factor) {
    Points displacement(rest.size(), Eigen::Vector3d::Zero());
    for (const auto& [selection, motion] : moved)
      for (const int n : selection.nodes) {
        const auto node = static_cast<std::size_t>(n);
        const Eigen::Vector3d by = cases::moved_by(motion, rest[node], load_factor);
        for (std::size_t a = 0; a < 3; ++a)
          if (motion.components[a]) displacement[node][static_cast<int>(a)] = by[static_cast<int>(a)];
      }
    return displacement;
  };
}

} // namespace

Problem make_problem(const cases::Scene& scene) {
  return {scene.mesh, {}, cases::nodal_forces(scene), cases::constrained_dofs(scene), moving_supports(scene)};
}

void measure_cells(const cases::HexMesh& mesh, cases::Solution& solution) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto vertices = cases::cell_vertices(mesh, c, solution.displacement);
    solution.cell_volume.push_back(cases::cell_volume(vertices));
    if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++solution.inverted_cells;
  }
}

} // namespace springproof::msm
