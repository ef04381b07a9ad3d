#pragma once

#include <cstddef>

namespace springproof::mechanics::grid {

/// How the nodes of a grid lie in memory: node (i, j, k) has index at(i, j, k, c) in array c. A field of
/// vectors is three such arrays, x, y and z, one after the other. Between rows, before the first node and
/// after the last one lie ghosts, as many as a model's kernels want: its make_layout() fills this in.
struct Layout {
  int nodes[3] = {0, 0, 0};
  std::ptrdiff_t row = 0;   ///< distance from one row to the next
  std::ptrdiff_t plane = 0; ///< distance from one plane to the next
  std::ptrdiff_t lead = 0;  ///< ghosts before the first node
  std::ptrdiff_t size = 0;  ///< entries of one array, ghosts and all
  std::ptrdiff_t at(int i, int j, int k, int c = 0) const {
    return c * size + lead + i + row * j + plane * k;
  }
  struct Place {
    int i, j, k, c;
  };
  /// The node and the component of an entry that at() gives.
  Place place(std::ptrdiff_t entry) const {
    const std::ptrdiff_t in_array = entry % size - lead, in_plane = in_array % plane;
    return {static_cast<int>(in_plane % row), static_cast<int>(in_plane / row),
            static_cast<int>(in_array / plane), static_cast<int>(entry / size)};
  }
  /// Cell (i, j, k) in arrays of cells, whose rows are as long as those of nodes.
  std::ptrdiff_t cell(int i, int j, int k) const { return i + row * (j + std::ptrdiff_t{nodes[1] - 1} * k); }
  std::ptrdiff_t n_cell_entries() const { return row * (nodes[1] - 1) * (nodes[2] - 1); }
  /// Row (j, k) of nodes among all.
  std::ptrdiff_t node_row(int j, int k) const { return j + std::ptrdiff_t{nodes[1]} * k; }
};

} // namespace springproof::mechanics::grid
