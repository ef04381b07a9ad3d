#include "msm/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/direct/moving_lattice.hpp"
#include "msm/grid/moving_grid.hpp"

#include <utility>

namespace springproof::msm {

namespace {

/// Displacement when the motion begins, mm, one per point.
/// @param springs  as a Model takes them
template<class Springs>
Points start_of(const cases::Scene& scene, const Springs& springs, const ModelOptions& options,
                const mechanics::IntegrationSettings& steps) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest)
    return Points(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  // What a step in real time may leave is no equilibrium.
  const auto settings = steps.enough_linear_iterations ? mechanics::EquilibriumSettings{} : steps.newton;
  return Model(cases::scene_before_start(scene), springs, options).solve(settings).displacement;
}

double volume_of(const cases::HexMesh& mesh, const Points& displacement) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_vertices(mesh, c, displacement));
  return volume;
}

/// On any path.
cases::Solution follow(const cases::Scene& scene, const Problem& problem, MovingSprings& motion, Vector start,
                       const std::function<Points(const Vector&)>& to_points,
                       const mechanics::IntegrationSettings& settings) {
  const mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {motion, to_points, [&](const Vector& state) { return volume_of(problem.mesh, to_points(state)); }},
      std::move(start), settings);
  cases::Solution solution = solution_of(problem, followed.work, to_points(followed.end));
  solution.trajectory = followed.trajectory;
  return solution;
}

} // namespace

cases::Solution follow(const cases::Scene& scene, Lattice lattice, Lattice damping,
                       const mechanics::IntegrationSettings& settings) {
  Problem problem = make_moving_problem(scene);
  problem.lattice = std::move(lattice);
  const auto statics = make_direct_system(problem);
  const auto motion = make_moving_lattice(problem, *statics, make_inertia(scene, std::move(damping)));
  return follow(
      scene, problem, *motion, to_vector(problem, start_of(scene, problem.lattice, {}, settings)),
      [&](const Vector& state) { return to_points(problem, state); }, settings);
}

cases::Solution follow(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                       const ModelOptions& options, const mechanics::IntegrationSettings& settings) {
  const auto factorised = [&] {
    return follow(scene, make_lattice(scene.mesh, stiffness), damping_lattice(scene, stiffness), settings);
  };
  if (!takes_multigrid(scene, stiffness, options.path)) return factorised();
  const Problem problem = make_moving_problem(scene);
  const grid::GridProblem grid = grid::make_grid_problem(problem, stiffness);
  const auto statics = grid::make_grid_system(grid, options.n_threads);
  const auto motion = grid::make_moving_grid(problem, grid, *statics, make_inertia(scene, {}),
                                             damping_stiffness(scene, stiffness), options.n_threads);
  Vector start = grid::to_field(problem, grid.body, start_of(scene, stiffness, options, settings));
  const auto points = [&](const Vector& state) { return grid::to_points(problem, grid.body, state); };
  try {
    return follow(scene, problem, *motion, std::move(start), points, settings);
  } catch (const cases::SolveError&) {
    const bool may_be_factorised =
        options.path == Path::automatic && scene.mesh.nodes.size() <= most_factorised;
    if (!may_be_factorised || !motion->has_failed()) throw;
  }
  return factorised();
}

} // namespace springproof::msm
