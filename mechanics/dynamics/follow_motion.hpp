#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/time_integrator.hpp"

#include <functional>

namespace springproof::mechanics {

/// A model's body as the driver sees it. Vectors are in the problem's order.
struct BodyInTime {
  DynamicProblem& problem;
  std::function<std::vector<Eigen::Vector3d>(const Vector&)> displacement; ///< mm, one per node of the mesh
  std::function<double(const Vector&)> volume;                             ///< mm³
};

struct FollowedMotion {
  Vector end; ///< displacement, mm
  cases::Trajectory trajectory;
  Equilibrium work; ///< of all steps; its residual is the last step's
};

/// Moves a body through the time of its case's [dynamics], from a displacement without velocity.
/// @throws cases::InputError where a region turns too far in a step (cases::check_turns_in_time())
/// @throws cases::SolveError, whose load reached is the part of the time, when a step's equation is not
/// solved, halved as it is
FollowedMotion follow_motion(const cases::Scene& scene, const BodyInTime& body, Vector start,
                             const IntegrationSettings& settings = {});

} // namespace springproof::mechanics
