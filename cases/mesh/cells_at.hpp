#pragma once

#include "cases/mesh/sharing.hpp"

#include <limits>

namespace springproof::cases {

/// The cells of the body at rest that hold a point, in ascending order: one inside a cell, several on the
/// faces, edges and vertices between them, none outside the body. A cell's map from the unit cube is inverted
/// by Newton's method; 1e-6 of its edge counts as inside.
/// @param point  mm    @param among  the numbers of the cells that are looked at
std::vector<std::size_t> cells_at(const HexMesh& mesh, const Eigen::Vector3d& point,
                                  const Range& among = {0, std::numeric_limits<std::size_t>::max()});

} // namespace springproof::cases
