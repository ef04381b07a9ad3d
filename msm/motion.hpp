#pragma once

#include "mechanics/dynamics/follow_motion.hpp"
#include "msm/lattice.hpp"

namespace springproof::msm {

/// The motion of a scene's springs through the time of its [dynamics], on the direct path.
/// @param lattice  of the springs   @param damping  damping_lattice() of the same
/// @return the end of the motion, with its trajectory
/// @throws cases::SolveError with the time reached when the motion cannot be followed, or with the load
/// reached when it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene, Lattice lattice, Lattice damping,
                       const mechanics::IntegrationSettings& settings = {});

} // namespace springproof::msm
