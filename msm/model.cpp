#include "msm/model.hpp"

namespace msm {

Model::Model(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness)
    : mesh_(scene.mesh), problem_{make_lattice(scene.mesh, stiffness), cases::nodal_forces(scene),
                                  cases::fixed_degrees_of_freedom(scene)},
      solver_(problem_) {}

cases::Solution Model::solve() {
  const Equilibrium equilibrium = solver_.solve(problem_.lattice.rest);
  cases::Solution solution;
  solution.status = cases::Status::converged;
  solution.unknowns = static_cast<std::size_t>(solver_.n_free());
  solution.residual = equilibrium.residual;
  solution.load_reached = equilibrium.load_reached;
  solution.newton_iterations = equilibrium.newton_iterations;
  for (std::size_t p = 0; p < equilibrium.positions.size(); ++p)
    solution.displacement.push_back(equilibrium.positions[p] - problem_.lattice.rest[p]);
  for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
    const auto vertices = cases::cell_vertices(mesh_, c, solution.displacement);
    solution.cell_volume.push_back(cases::cell_volume(vertices));
    if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++solution.inverted_cells;
  }
  return solution;
}

} // namespace msm
