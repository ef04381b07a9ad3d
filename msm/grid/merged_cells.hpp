#pragma once

#include "mechanics/grid/cycle.hpp"
#include "msm/grid/body.hpp"

namespace springproof::msm::grid {

/// Cells of a grid and their nodes. Nodes are numbers: where the body has a gap, two may have the same place.
struct Cells {
  std::vector<std::array<int, 3>> places{};
  std::vector<std::array<int, 8>> nodes{}; ///< each cell's, by the bits of x, y, z
  int n_nodes = 0;
};

/// Rows of weights: row r has entries start[r] to start[r + 1] - 1.
struct Weights {
  struct Entry {
    int column;
    float weight;
  };
  std::vector<int> start{0};
  std::vector<Entry> entries{};
};
Weights transposed(const Weights& weights, int n_columns);

/// Cells merged into coarser ones that hang together as they do. A coarse cell of a grid's body reaches over
/// gaps narrower than itself, and moves both sides as one; here it is doubled, each side having one.
/// Neighbouring coarse cells share a node only where a finer node is interpolated from both. (Composite
/// elements as of Nesme, Kry, Jerabkova, Faure 2009, that meet as the fine ones do.)
struct MergedCells {
  Cells cells;
  /// Finer cells by coarse ones: cell c has those from first_finer[c] to first_finer[c + 1] - 1.
  std::vector<int> first_finer, finer_cells;
  std::vector<std::array<int, 3>> begins_at; ///< each finer cell's place in the coarse one, 0 or 1
  std::array<int, 3> factor;                 ///< finer cells along each axis of a coarse one, 1 or 2
  Weights interpolation;                     ///< a row for every finer node, a column for every coarse one
};
MergedCells merge(const Cells& finer, const std::array<int, 3>& factor);

/// Weight of a coarse cell's corner at a finer cell's.
double weight_at(const std::array<int, 3>& begins_at, const std::array<int, 3>& factor, int finer,
                 int coarse);

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
