#include "msm/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "msm/moving_body.hpp"

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

cases::Solution follow(const cases::Scene& scene, MovingBody& body, const Points& start,
                       const mechanics::IntegrationSettings& settings) {
  const auto points = [&](const Vector& state) { return body.to_points(state); };
  const mechanics::FollowedMotion followed = mechanics::follow_motion(
      scene,
      {body.motion(), points,
       [&](const Vector& state) { return volume_of(body.problem().mesh, points(state)); }},
      body.to_vector(start), settings);
  cases::Solution solution = solution_of(body.problem(), followed.work, points(followed.end));
  solution.trajectory = followed.trajectory;
  return solution;
}

} // namespace

cases::Solution follow(const cases::Scene& scene, Lattice lattice, Lattice damping,
                       const mechanics::IntegrationSettings& settings) {
  MovingBody body(scene, std::move(lattice), std::move(damping));
  return follow(scene, body, start_of(scene, body.problem().lattice, {}, settings), settings);
}

cases::Solution follow(const cases::Scene& scene, const std::vector<CellStiffness>& stiffness,
                       const ModelOptions& options, const mechanics::IntegrationSettings& settings) {
  MovingBody body(scene, stiffness, options);
  if (!body.is_on_grid())
    return follow(scene, body, start_of(scene, body.problem().lattice, {}, settings), settings);
  try {
    return follow(scene, body, start_of(scene, stiffness, options, settings), settings);
  } catch (const cases::SolveError&) {
    const bool may_be_factorised =
        options.path == Path::automatic && scene.mesh.nodes.size() <= most_factorised;
    if (!may_be_factorised || !body.motion().has_failed()) throw;
  }
  return follow(scene, make_lattice(scene.mesh, stiffness), damping_lattice(scene, stiffness), settings);
}

} // namespace springproof::msm
