#include "msm/design/minimise.hpp"

#include "cases/case/error.hpp"

#include <Eigen/QR>
#include <glog/logging.h>
#include <vector>

namespace springproof::msm {

ceres::Solver::Summary minimise(ceres::Problem& problem, ceres::Solver::Options options) {
  options.linear_solver_type = ceres::DENSE_QR;
  options.logging_type = ceres::SILENT;
  FLAGS_minloglevel = google::GLOG_FATAL; // silences Ceres, whatever logging_type
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

Eigen::VectorXd nonnegative_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target) {
  const Eigen::Index n = matrix.cols();
  // Q^T turns many rows into as many as there are unknowns.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  const Eigen::VectorXd reduced = (qr.householderQ().adjoint() * target).head(n);
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd unbounded = triangle.triangularView<Eigen::Upper>().solve(reduced);
  if (unbounded.minCoeff() >= 0) return unbounded;
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double least = reduced.norm();
  for (unsigned choice = 1; choice < 1U << n; ++choice) {
    std::vector<Eigen::Index> free;
    for (Eigen::Index i = 0; i < n; ++i)
      if ((choice >> i & 1U) != 0) free.push_back(i);
    const Eigen::MatrixXd columns = triangle(Eigen::all, free);
    const Eigen::VectorXd x = columns.householderQr().solve(reduced);
    const double distance = (columns * x - reduced).norm();
    if (!(x.minCoeff() >= 0 && distance < least)) continue;
    least = distance;
    best.setZero();
    best(free) = x;
  }
  return best;
}

} // namespace springproof::msm
