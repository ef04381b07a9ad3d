#include "msm/pull.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/LU>
#include <cmath>

namespace springproof::msm {

template<class Real>
Eigen::Vector3d Pull::place(const VectorIn<Real>& displacement) const {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      mean[c] += entry.weight * static_cast<double>(displacement[entry.at]);
  return mean;
}

template<class Real>
void Pull::add(const Eigen::Vector3d& force, VectorIn<Real>& to) const {
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) to[entry.at] += static_cast<Real>(entry.weight * force[c]);
}

template Eigen::Vector3d Pull::place(const Vector&) const;
template void Pull::add(const Eigen::Vector3d&, Vector&) const;
template Eigen::Vector3d Pull::place(const VectorIn<float>&) const;
template void Pull::add(const Eigen::Vector3d&, VectorIn<float>&) const;

double Pull::size(const Vector& displacement) const {
  const Eigen::Vector3d pulls = force(displacement);
  double squared = 0;
  for (int c = 0; c < 3; ++c)
    for (const Entry& entry : entries_[cases::index(c)])
      if (entry.is_free) squared += std::pow(entry.weight * pulls[c], 2);
  return std::sqrt(squared);
}

template<class Real>
void WithPull<Real>::prepare(const Pull& pull, Eigen::Index size,
                             const std::function<void(const VectorIn<Real>&, VectorIn<Real>&)>& invert) {
  Eigen::Matrix3d compliance; // W^T Y, mm/N
  for (int c = 0; c < 3; ++c) {
    unit_.setZero(size);
    pull.add(Eigen::Vector3d::Unit(c), unit_);
    VectorIn<Real>& column = columns_[cases::index(c)];
    column.setZero(size);
    invert(unit_, column);
    compliance.col(c) = pull.place(column);
  }
  const Eigen::Matrix3d symmetric = (compliance + compliance.transpose()) / 2; // but for rounding
  matters_ = !(pull.stiffness() * symmetric.trace() <= 1); // the trace bounds its largest eigenvalue
  inverse_ = (Eigen::Matrix3d::Identity() / pull.stiffness() + symmetric).inverse();
}

template<class Real>
void WithPull<Real>::correct(const Pull& pull, VectorIn<Real>& solution) const {
  const Eigen::Vector3d factors = inverse_ * pull.place(solution);
  for (int c = 0; c < 3; ++c) solution -= static_cast<Real>(factors[c]) * columns_[cases::index(c)];
}

template class WithPull<double>;
template class WithPull<float>;

} // namespace springproof::msm
