#pragma once

#include "cases/case/boundary.hpp"
#include "cases/mesh/mesh.hpp"

/// How thick a body is, counted in cells.
namespace springproof::cases {

/// The fewest cells, for each cell, in a row through it from one side of the body to the other: the least of
/// the three rows along its edges, 1 in a plate of one cell. A plane of symmetry mirrors a row; a closed ring
/// has no ends, and does not count.
/// @param most  what is more counts as so many
std::vector<int> cells_across(const Mesh& mesh, const std::vector<Fixed>& symmetry, int most);

} // namespace springproof::cases
