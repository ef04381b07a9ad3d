#pragma once

#include "cases/mesh/hex_mesh.hpp"

namespace springproof::cases {

/// The present cells of a grid, in pieces that hang together by faces.
struct Pieces {
  std::vector<int> piece_of_cell; ///< for every place of the grid, -1 where no cell is
  std::vector<std::size_t> sizes; ///< cells of each piece
};

/// @param grid  with `present`
Pieces pieces_of(const Grid& grid);

} // namespace springproof::cases
