#include "msm/motion.hpp"

#include "cases/scene/in_time.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/direct/moving_lattice.hpp"
#include "msm/model.hpp"

#include <utility>

namespace springproof::msm {

namespace {

/// Displacement when the motion begins, mm, one per point.
Points start_of(const cases::Scene& scene, const Lattice& lattice,
                const mechanics::EquilibriumSettings& settings) {
  if (scene.definition.dynamics->start == cases::MotionStart::rest)
    return Points(lattice.rest.size(), Eigen::Vector3d::Zero());
  return Model(cases::scene_before_start(scene), lattice).solve(settings).displacement;
}

double volume_of(const cases::HexMesh& mesh, const Points& displacement) {
  double volume = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    volume += cases::cell_volume(cases::cell_vertices(mesh, c, displacement));
  return volume;
}

} // namespace

cases::Solution follow(const cases::Scene& scene, Lattice lattice, Lattice damping,
                       const mechanics::IntegrationSettings& settings) {
  Problem problem = make_moving_problem(scene);
  problem.lattice = std::move(lattice);
  const auto statics = make_direct_system(problem);
  const auto motion = make_moving_lattice(problem, *statics, make_inertia(scene, std::move(damping)));
  const auto displacement = [&](const Vector& state) { return to_points(problem, state); };
  const mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {*motion, displacement,
       [&](const Vector& state) { return volume_of(problem.mesh, displacement(state)); }},
      to_vector(problem, start_of(scene, problem.lattice, settings.newton)), settings);
  cases::Solution solution = solution_of(problem, followed.work, displacement(followed.end));
  solution.trajectory = followed.trajectory;
  return solution;
}

} // namespace springproof::msm
