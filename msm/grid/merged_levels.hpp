#pragma once

#include "mechanics/grid/cycle.hpp"
#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Adds the levels below the finest one of a body with gaps: coarse cells that hang together as the fine ones
/// do (MergedCells), with Galerkin's stiffness P^T K P of the clamped tangent, gathered cell by cell, as
/// sparse matrices of 3x3 blocks. Rediscretised coarse lattices (coarsen()) join what a narrow gap parts, and
/// their cells at a boundary are wrong by as much as they are empty: a head at 1.6 mm takes two to four times
/// the iterations of conjugate gradients with them.
/// @param finest        is no part of a body; must outlive the levels, as must the fields
/// @param displacement  mm, the finest body's when the levels are linearised
/// @param added         added to its tangent's diagonal; empty: nothing
void add_merged_levels(const Body& finest, const Field<float>& displacement, const Field<float>& added,
                       int n_threads, std::vector<std::unique_ptr<mechanics::grid::Level>>& levels);

} // namespace springproof::msm::grid
