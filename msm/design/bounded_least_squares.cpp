#include "msm/design/bounded_least_squares.hpp"

#include "cases/case/error.hpp"
#include "msm/design/minimise.hpp"

#include <Eigen/QR>
#include <ceres/normal_prior.h>

namespace springproof::msm {

Eigen::VectorXd bounded_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& target,
                                      double unit) {
  const Eigen::Index n = matrix.cols();
  // Where no bound matters, the answer is direct and exact; otherwise Q^T turns many rows into as many as
  // there are unknowns.
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(matrix);
  const Eigen::VectorXd reduced = (qr.householderQ().adjoint() * target).head(n);
  const Eigen::MatrixXd triangle = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  const Eigen::VectorXd unbounded = triangle.triangularView<Eigen::Upper>().solve(reduced);
  if (unbounded.minCoeff() >= 0) return unbounded;

  Eigen::VectorXd scaled = (unbounded / unit).cwiseMax(0.1);
  const double size = reduced.norm();
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::NormalPrior(triangle * unit / size, unbounded / unit), nullptr,
                           scaled.data());
  for (int c = 0; c < n; ++c) problem.SetParameterLowerBound(scaled.data(), c, 0);
  ceres::Solver::Options options;
  options.max_num_iterations = 500;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-13;
  options.parameter_tolerance = 1e-13;
  minimum_of(problem, options, "bounded least squares");
  return unit * scaled;
}

} // namespace springproof::msm
