#pragma once

#include "msm/grid/grid_system.hpp"
#include "msm/grid/node_vectors.hpp"
#include "msm/moving_springs.hpp"

namespace springproof::msm::grid {

/// The motion of a lattice on a grid of cells without a matrix: conjugate gradients on the tangent, mass and
/// damping together. Small bodies have the factor of their first step as preconditioner; large ones, and
/// those that moved too far from it, a multigrid cycle that is prepared anew where it has become slow; steps
/// in real time by cycles are in single precision (RealTimeSolver). After the first steps it allocates
/// nothing; the motion does not depend on the number of threads.
/// @param vectors    the motion's, for grid.body; must outlive what is returned, as must grid and statics
/// @param statics    equations of `grid`
/// @param inertia    its damping is not used
/// @param damping    cells of damping_springs()
std::unique_ptr<MovingSprings> make_moving_grid(const Problem& problem, const GridProblem& grid,
                                                const NodeVectors& vectors, GridSystem& statics,
                                                const Inertia& inertia,
                                                const std::vector<CellStiffness>& damping, int n_threads);

} // namespace springproof::msm::grid
