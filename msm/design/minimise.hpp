#pragma once

#include <array>
#include <ceres/ceres.h>
#include <optional>
#include <string>

namespace springproof::msm {

/// Minimises a sum of squares of few unknowns by Ceres with dense QR, and silently: a start that fails need
/// not be an error.
/// @param options  tolerances and limits
ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options);

/// The same where the first start has to succeed.
/// @param what  begins the message    @return the sum of the squares at the minimum    @throws SolveError
double minimum_of(ceres::Problem& problem, const ceres::Solver::Options& options, const std::string& what);

/// minimum_of() a problem in the three exponents of power-log springs, and perhaps more, to which the squares
/// of exponent_prior (p - start) are added.
/// @param exponents  p, parameters of the problem that begin within the bound
/// @param start  where the prior holds them    @param lowest  exponent, if there is one
double minimum_over_exponents(ceres::Problem& problem, std::array<double, 3>& exponents, double start,
                              const std::optional<double>& lowest, const std::string& what);

} // namespace springproof::msm
