#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace springproof::compare {

/// A field on the nodes of a box's grid, trilinear between them, at the nodes of another grid of the same
/// box.
/// @param field     one vector per node, x fastest
/// @param from, to  cells along x, y, z
std::vector<Eigen::Vector3d> interpolate(const std::vector<Eigen::Vector3d>& field,
                                         const std::array<int, 3>& from, const std::array<int, 3>& to);

} // namespace springproof::compare
