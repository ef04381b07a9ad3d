#pragma once

#include "mechanics/petsc/handles.hpp"

#include <Eigen/Core>
#include <vector>

namespace springproof::mechanics::petsc {

/// Gives a matrix of 3x3 blocks the rigid motions of its points as near null space: what algebraic multigrid
/// must represent on its coarse levels.
/// @param points  rest positions (mm), those of this rank's rows first; any behind them are not looked at
void attach_rigid_motions(Mat matrix, const std::vector<Eigen::Vector3d>& points);

} // namespace springproof::mechanics::petsc
