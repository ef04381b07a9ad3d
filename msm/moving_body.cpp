#include "msm/moving_body.hpp"

#include "msm/direct/direct_system.hpp"
#include "msm/direct/moving_lattice.hpp"
#include "msm/grid/moving_grid.hpp"

#include <utility>

namespace springproof::msm {

MovingBody::MovingBody(const cases::Scene& scene, Lattice lattice, Lattice damping)
    : problem_(make_moving_problem(scene)) {
  factorise(scene, std::move(lattice), std::move(damping));
}

MovingBody::MovingBody(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                       const ModelOptions& options)
    : problem_(make_moving_problem(scene)) {
  if (!takes_multigrid(scene, stiffness, options.path)) {
    factorise(scene, make_lattice(scene.mesh, stiffness), damping_lattice(scene, stiffness));
    return;
  }
  grid_ = grid::make_grid_problem(problem_, stiffness);
  statics_ = grid::make_grid_system(*grid_, options.n_threads);
  motion_ = grid::make_moving_grid(problem_, *grid_, *statics_, make_inertia(scene, {}),
                                   damping_stiffness(scene, stiffness), options.n_threads);
}

void MovingBody::factorise(const cases::Scene& scene, Lattice lattice, Lattice damping) {
  problem_.lattice = std::move(lattice);
  statics_ = make_direct_system(problem_);
  motion_ = make_moving_lattice(problem_, *statics_, make_inertia(scene, std::move(damping)));
}

Vector MovingBody::to_vector(const Points& points) const {
  return grid_ ? grid::to_field(problem_, grid_->body, points) : msm::to_vector(problem_, points);
}

Points MovingBody::to_points(const Vector& vector) const {
  return grid_ ? grid::to_points(problem_, grid_->body, vector) : msm::to_points(problem_, vector);
}

Vector MovingBody::forces(const std::vector<cases::NodeVector>& of_nodes) const {
  Points force = problem_.on_all_points(of_nodes);
  for (std::size_t p = 0; p < force.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c)
      if (problem_.is_constrained[3 * p + c]) force[p][static_cast<Eigen::Index>(c)] = 0;
  return to_vector(force);
}

} // namespace springproof::msm
