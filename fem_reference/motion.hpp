#pragma once

#include "mechanics/dynamics/follow_motion.hpp"

namespace springproof::fem_reference {

/// The usual limits of a step in time of finite elements: those of a path's load step.
mechanics::IntegrationSettings default_steps();

/// The motion of a scene's finite elements through the time of its [dynamics], assembled, in this process
/// alone.
/// @return the end of the motion, with its trajectory
/// @throws InputError as Model
/// @throws SolveError with the time reached when the motion cannot be followed, or with the load reached when
/// it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene,
                       const mechanics::IntegrationSettings& settings = default_steps());

} // namespace springproof::fem_reference
