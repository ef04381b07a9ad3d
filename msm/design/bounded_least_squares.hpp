#pragma once

#include <Eigen/Core>

namespace springproof::msm {

/// The x >= 0 that minimises |A x - b|, by Ceres; unique when A has full column rank.
/// @param matrix   A, any units    @param target  b
/// @param unit     expected size of x's components, > 0: the solver works with x/unit
/// @throws SolveError when the minimisation fails
Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target,
                                      double unit);

} // namespace springproof::msm
