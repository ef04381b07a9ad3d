#pragma once

#include "cases/mesh/sharing.hpp"

#include "mechanics/hexahedron.hpp"

#include <limits>

namespace springproof::cases {

/// The cells of the body at rest that hold a point, in ascending order: one inside a cell, several on the
/// faces, edges and vertices between them, none outside the body. A cell's map from the unit cube is inverted
/// by Newton's method; 1e-6 of its edge counts as inside.
/// @param point  mm    @param among  the numbers of the cells that are looked at
std::vector<std::size_t> cells_at(const HexMesh& mesh, const Eigen::Vector3d& point,
                                  const Range& among = {0, std::numeric_limits<std::size_t>::max()});

/// The place of a point in a cell's unit cube, by Newton's method, to 1e-9 of the cell's largest edge: in the
/// cube or next to it. Nothing far outside of the cell, where its map may fold back.
/// @param point  mm
std::optional<Eigen::Vector3d> place_in_cell(const mechanics::HexahedronVertices& vertices,
                                             const Eigen::Vector3d& point);

} // namespace springproof::cases
