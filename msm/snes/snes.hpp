#pragma once

#include "msm/grid/grid_system.hpp"
#include "msm/spring_body.hpp"

#include <mpi.h>

namespace springproof::msm {

/// Static equilibrium of a scene's lattice over the ranks of a communicator. Where msm::Model would take its
/// multigrid path, that path with the grid's nodes dealt out in bricks (deal_out_to()): the same iterations
/// on any number of ranks. Elsewhere by PETSc: SNES' Newton method with a line search on the imbalance, an
/// assembled matrix of 3x3 blocks, and MUMPS up to 30,000 unknowns; above them conjugate
/// gradients with algebraic multigrid (GAMG) that knows the rigid motions. Load steps are halved where SNES
/// fails. PETSC_OPTIONS reach SNES with the prefix msm_. Collective: points are dealt out to the ranks, which
/// all know the whole scene and share the answer (Solution::sharing).
/// @param start      displacement (mm) to start from, one per node; empty: rest
/// @throws cases::SolveError with the load reached when the load cannot be carried
cases::Solution solve_by_snes(const cases::Scene& scene, const SpringBody& springs, MPI_Comm communicator,
                              const mechanics::EquilibriumSettings& settings = {}, const Points& start = {});

/// Deals a grid's nodes out to the ranks of a communicator, in bricks of about equal size whose faces are
/// smallest together, and the coarser grids with it: a coarse node belongs to the owner of the fine node at
/// its place. Where bricks would have too few nodes, all ranks have the whole of the coarse body. A body that
/// is too small to be dealt out comes back whole. Ghosts go through PETSc's star forests.
grid::DealOut deal_out_to(MPI_Comm communicator);

} // namespace springproof::msm
