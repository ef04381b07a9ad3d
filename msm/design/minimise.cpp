#include "msm/design/minimise.hpp"

#include "cases/case/error.hpp"
#include "msm/design/exponents.hpp"

#include <ceres/normal_prior.h>
#include <glog/logging.h>

namespace springproof::msm {

ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options) {
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  FLAGS_minloglevel = google::GLOG_FATAL; // of Ceres, whatever logging_type
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary;
}

double minimum_of(ceres::Problem& problem, const ceres::Solver::Options& options, const std::string& what) {
  const ceres::Solver::Summary summary = minimise(problem, options);
  if (!summary.IsSolutionUsable())
    throw cases::SolveError(what + ": the minimisation failed: " + summary.message);
  return 2 * summary.final_cost;
}

double minimum_over_exponents(ceres::Problem& problem, std::array<double, 3>& exponents, double start,
                              const std::optional<double>& lowest, const std::string& what) {
  problem.AddResidualBlock(
      new ceres::NormalPrior(exponent_prior * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Constant(start)),
      nullptr, exponents.data());
  for (int kind = 0; lowest && kind < 3; ++kind)
    problem.SetParameterLowerBound(exponents.data(), kind, *lowest);
  ceres::Solver::Options options;
  options.function_tolerance = 1e-14;
  options.parameter_tolerance = 1e-10;
  return minimum_of(problem, options, what);
}

} // namespace springproof::msm
