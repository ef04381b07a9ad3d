#pragma once

#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "mechanics/state_on_mesh.hpp"

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
  Equilibrium work; ///< totals of all steps; the residual is the last step's
};

/// Moves a body through the time of its case's [dynamics], from a displacement without velocity.
/// @throws cases::InputError where a region turns too far in a step (cases::check_turns_in_time())
/// @throws cases::SolveError when a step's equation is not solved even after halvings; its load reached is
/// the fraction of the time
FollowedMotion follow_motion(const cases::Scene& scene, const BodyInTime& body, Vector start,
                             const IntegrationSettings& settings = {});

/// What becomes of a body that still moves at the end: a failure, or its mean places over the second half of
/// the time, as clients give them.
enum class StillMoving { fails, has_mean };

/// Where a body without history comes to rest.
struct CameToRest {
  Vector state;
  double time; ///< s
  long steps;
  std::optional<double> mean_from; ///< s; it still moves, and the state is its mean from here on
  Equilibrium work; ///< totals of all steps; the residual is the last step's
};

/// Steps until the nodes have stayed within 1e-4 of the largest displacement for half a second, as clients
/// do.
/// @param step, end  s: of each step, and within which it must come to rest
/// @throws cases::SolveError when it does not, unless its mean is wanted, or when a step's equation is not
/// solved
CameToRest come_to_rest(const BodyInTime& body, Vector start, double step, double end,
                        const IntegrationSettings& settings, StillMoving still_moving = StillMoving::fails);

/// The same as follow_motion() above, over the ranks that share the states of a model. Collective.
/// @param state  where the motion starts; afterwards where it ends
/// @return the end of the motion, which the ranks share, and the trajectory, which each of them has
cases::Solution follow_motion(const cases::Scene& scene, DynamicProblem& problem, const StateOnMesh& on_mesh,
                              Vector& state, const IntegrationSettings& settings);

} // namespace springproof::mechanics
