#include "mechanics/real_time/pull_of_points.hpp"

namespace springproof::mechanics {

using Eigen::Vector3d;

Vector3d PullOfPoints::mean(const Points& of) const {
  Vector3d mean = Vector3d::Zero();
  for (const auto& [point, weight] : weights) mean += weight * of[point];
  return mean;
}

void PullOfPoints::add_product(const std::vector<int>& number, const Eigen::VectorXd& in,
                               Eigen::VectorXd& out) const {
  for (std::size_t c = 0; c < 3; ++c) {
    double mean = 0;
    for (const auto& [point, weight] : weights)
      if (const int at = number[3 * point + c]; at >= 0) mean += weight * in[at];
    for (const auto& [point, weight] : weights)
      if (const int at = number[3 * point + c]; at >= 0) out[at] += stiffness * weight * mean;
  }
}

void project_pull(const PullOfPoints& pull,
                  const std::function<Vector3d(std::size_t, const Vector3d&)>& moved_by, Vector3d& force,
                  PullOfPoints::Points& at) {
  Vector3d moved = Vector3d::Zero(); // mm: of the mean, by 1 N
  for (const auto& [point, weight] : pull.weights)
    moved += weight * weight * moved_by(point, Vector3d::Ones());
  const Vector3d change = (pull.force(at) - force).cwiseQuotient(Vector3d::Ones() + pull.stiffness * moved);
  for (const auto& [point, weight] : pull.weights) at[point] += moved_by(point, weight * change);
  force += change;
}

} // namespace springproof::mechanics
