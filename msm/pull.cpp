#include "msm/pull.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/LU>
#include <cmath>

namespace springproof::msm {

Eigen::Vector3d Pull::place(const Vector& displacement) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)]) mean[c] += entry.weight * displacement[entry.at];
  return mean;
}

void Pull::add(const Eigen::Vector3d& force, Vector& to) const {
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) to[entry.at] += entry.weight * force[c];
}

double Pull::size(const Vector& displacement) const {
  const Eigen::Vector3d pulls = force(displacement);
  double squared = 0;
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) squared += std::pow(entry.weight * pulls[c], 2);
  return std::sqrt(squared);
}

void WithPull::prepare(const Pull& pull, Eigen::Index size,
                       const std::function<void(const Vector&, Vector&)>& invert) {
  Eigen::Matrix3d compliance; // W^T Y, mm/N
  for (int c = 0; c < 3; ++c) {
    unit_.setZero(size);
    pull.add(Eigen::Vector3d::Unit(c), unit_);
    Vector& column = columns_[cases::index(c)];
    column.setZero(size);
    invert(unit_, column);
    compliance.col(c) = pull.place(column);
  }
  const Eigen::Matrix3d symmetric = (compliance + compliance.transpose()) / 2; // but for rounding
  matters_ = !(pull.stiffness() * symmetric.trace() <= 1); // the trace bounds its largest eigenvalue
  inverse_ = (Eigen::Matrix3d::Identity() / pull.stiffness() + symmetric).inverse();
}

void WithPull::correct(const Pull& pull, Vector& solution) const {
  const Eigen::Vector3d factors = inverse_ * pull.place(solution);
  for (int c = 0; c < 3; ++c) solution -= factors[c] * columns_[cases::index(c)];
}

} // namespace springproof::msm
