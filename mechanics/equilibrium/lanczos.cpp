#include "mechanics/equilibrium/lanczos.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>

namespace springproof::mechanics {

using Eigen::MatrixXd;
using Eigen::VectorXd;

LargestMode largest_mode(const std::function<VectorXd(const VectorXd&)>& apply, Eigen::Index n) {
  const Eigen::Index max_steps = std::min<Eigen::Index>(60, n);
  MatrixXd basis(n, max_steps);
  VectorXd alpha(max_steps), beta(max_steps);
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  for (Eigen::Index i = 0; i < n; ++i) basis(i, 0) = normal(generator);
  basis.col(0).normalize();
  for (Eigen::Index step = 0;; ++step) {
    VectorXd next = apply(basis.col(step));
    alpha[step] = next.dot(basis.col(step));
    for (int pass = 0; pass < 2; ++pass) // twice is enough (Kahan)
      next -= basis.leftCols(step + 1) * (basis.leftCols(step + 1).transpose() * next);
    beta[step] = next.norm();
    Eigen::SelfAdjointEigenSolver<MatrixXd> ritz;
    ritz.computeFromTridiagonal(alpha.head(step + 1), beta.head(step));
    const double largest = ritz.eigenvalues()[step];
    const VectorXd weights = ritz.eigenvectors().col(step);
    // |A x - theta x| = beta |last weight|
    const bool converged = beta[step] * std::abs(weights[step]) <= 1e-6 * std::abs(largest);
    if (converged || step + 1 == max_steps)
      return {largest, (basis.leftCols(step + 1) * weights).normalized()};
    basis.col(step + 1) = next / beta[step];
  }
}

} // namespace springproof::mechanics
