#include "msm/motion.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/in_time.hpp"
#include "msm/moving_body.hpp"

#include <utility>

namespace springproof::msm {

namespace {

/// Displacement when the motion begins, mm, one per point.
Points start_of(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
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

cases::Solution follow(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options,
                       const mechanics::IntegrationSettings& settings) {
  ModelOptions directly = options;
  directly.path = Path::direct;
  MovingBody body(scene, springs, options);
  try {
    return follow(scene, body, start_of(scene, springs, body.is_on_grid() ? options : directly, settings),
                  settings);
  } catch (const cases::SolveError&) {
    const bool may_be_factorised =
        body.is_on_grid() && options.path == Path::automatic && scene.mesh.nodes.size() <= most_factorised;
    if (!may_be_factorised || !body.motion().has_failed()) throw;
  }
  return follow(scene, springs, directly, settings);
}

} // namespace springproof::msm
