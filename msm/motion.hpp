#pragma once

#include "mechanics/dynamics/follow_motion.hpp"
#include "msm/model.hpp"

namespace springproof::msm {

/// The motion of a scene's springs through the time of its [dynamics], on the path that a Model of them would
/// take; of the options, on which threads.
/// @return the end of the motion, with its trajectory
/// @throws cases::SolveError with the time reached when the motion cannot be followed, or with the load
/// reached when it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene, const SpringBody& springs, const ModelOptions& options = {},
                       const mechanics::IntegrationSettings& settings = {});

} // namespace springproof::msm
