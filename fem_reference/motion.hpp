#pragma once

#include "fem_reference/backend.hpp"
#include "mechanics/dynamics/follow_motion.hpp"

#include <mpi.h>

namespace springproof::fem_reference {

/// The usual limits of a step in time of finite elements: those of a path's load step.
mechanics::IntegrationSettings default_steps();

/// The motion of a scene's finite elements through the time of its [dynamics], over the ranks of a
/// communicator. Collective: they share the end of the motion, and each has the whole trajectory.
/// @param backend  automatic: the grid's where choose_backend() says so, and the assembled one where the
/// grid's
///                 linear solver fails
/// @return the end of the motion, with its trajectory
/// @throws InputError as Model
/// @throws SolveError with the time reached when the motion cannot be followed, or with the load reached when
/// it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene,
                       const mechanics::IntegrationSettings& settings = default_steps(),
                       Backend backend = Backend::automatic, MPI_Comm communicator = MPI_COMM_SELF);

} // namespace springproof::fem_reference
