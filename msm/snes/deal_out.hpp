#pragma once

#include "msm/grid/grid_system.hpp"

#include <mpi.h>

namespace springproof::msm {

/// Deals a grid's nodes out to the ranks of a communicator, in bricks of about equal size whose faces are
/// smallest together, and the coarser grids with it: a coarse node belongs to the owner of the fine node at
/// its place. Where bricks would have too few nodes, all ranks have the whole of the coarse body. A body that
/// is too small to be dealt out comes back whole. Ghosts go through PETSc's star forests.
grid::DealOut deal_out_to(MPI_Comm communicator);

} // namespace springproof::msm
