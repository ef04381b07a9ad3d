#pragma once

#include "mechanics/dynamics/follow_motion.hpp"
#include "msm/lattice.hpp"

#include <mpi.h>

namespace springproof::msm {

/// The motion of a scene's springs through the time of its [dynamics] over the ranks of a communicator: of
/// any lattice on any mesh. The equation of a step is solved by PETSc's SNES, with the tangent, mass and
/// damping in one assembled matrix, as in solve_lattice_by_snes(), with which a motion from equilibrium
/// begins. Collective: every rank knows the scene; they share the end of the motion (Solution::sharing), and
/// each has the whole trajectory.
/// @param lattice  of the springs   @param damping  damping_lattice() of the same
/// @return the end of the motion, with its trajectory
/// @throws cases::SolveError with the time reached when the motion cannot be followed, or with the load
/// reached when it cannot start in equilibrium
cases::Solution follow_lattice_by_snes(const cases::Scene& scene, Lattice lattice, Lattice damping,
                                       MPI_Comm communicator,
                                       const mechanics::IntegrationSettings& settings = {});

} // namespace springproof::msm
