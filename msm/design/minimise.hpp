#pragma once

#include <Eigen/Core>
#include <ceres/ceres.h>
#include <string>

namespace springproof::msm {

/// Minimises a sum of squares of few unknowns by Ceres with dense QR, and silently: a start that fails need
/// not be an error.
/// @param options  tolerances and limits
ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options);

/// The same where the first start has to succeed.
/// @param what  begins the message    @return the sum of the squares at the minimum    @throws SolveError
double minimum_of(ceres::Problem& problem, const ceres::Solver::Options& options, const std::string& what);

/// The x >= 0 that minimises |A x - b|, exactly: the least of the minima with some of its numbers 0 and the
/// others free whose free ones are not negative. For so few unknowns that every choice can be tried; unique
/// when A has full column rank.
/// @param matrix  A, any units    @param target  b
Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target);

} // namespace springproof::msm
