#include "msm/model.hpp"

namespace msm {

Model::Model(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness)
    : problem_(std::make_unique<Problem>(Problem{scene.mesh, make_lattice(scene.mesh, stiffness),
                                                 cases::nodal_forces(scene),
                                                 cases::fixed_degrees_of_freedom(scene)})),
      system_(make_direct_system(*problem_)) {}

cases::Solution Model::solve(const EquilibriumSettings& settings, const Points& start) {
  const Points from = start.empty() ? Points(problem_->lattice.rest.size(), Eigen::Vector3d::Zero()) : start;
  const Equilibrium equilibrium = find_equilibrium(*system_, to_vector(*problem_, from), settings);
  cases::Solution solution;
  solution.status = cases::Status::converged;
  solution.outcome =
      equilibrium.is_stable ? cases::Outcome::stable_equilibrium : cases::Outcome::unstable_equilibrium;
  solution.unknowns = static_cast<std::size_t>(equilibrium.displacement.size());
  solution.residual = equilibrium.residual;
  solution.load_reached = equilibrium.load_reached;
  solution.newton_iterations = equilibrium.newton_iterations;
  solution.linear_iterations = system_->linear_iterations();
  solution.lowest_eigenvalue = equilibrium.lowest_eigenvalue;
  solution.displacement = to_points(*problem_, equilibrium.displacement);
  for (std::size_t c = 0; c < problem_->mesh.cells.size(); ++c) {
    const auto vertices = cases::cell_vertices(problem_->mesh, c, solution.displacement);
    solution.cell_volume.push_back(cases::cell_volume(vertices));
    if (!(cases::smallest_corner_jacobian(vertices) > 0)) ++solution.inverted_cells;
  }
  return solution;
}

} // namespace msm
