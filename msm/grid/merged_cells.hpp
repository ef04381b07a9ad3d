#pragma once

#include <array>
#include <vector>

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

} // namespace springproof::msm::grid
