#pragma once

#include <ceres/ceres.h>

namespace springproof::msm {

/// Minimises a sum of squares of few unknowns by Ceres with dense QR, and silently: a start that fails need
/// not be an error.
/// @param options  tolerances and limits
ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options);

} // namespace springproof::msm
