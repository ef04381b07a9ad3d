#pragma once

#include "cases/mesh/cell_shape.hpp"

namespace springproof::cases {

/// Vertices of a child that refine() makes of a cell, 0 to 7, in the cell's reference cell.
CellCorners child_corners(CellShape shape, std::size_t child);

} // namespace springproof::cases
