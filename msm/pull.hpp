#pragma once

#include "mechanics/equilibrium/nonlinear_problem.hpp"

#include <array>
#include <functional>
#include <vector>

namespace springproof::msm {

using mechanics::Vector;
template<class Real>
using VectorIn = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// A spring between a place of a body and one outside of it: force = stiffness (target - place(u)), on the
/// nodes that the place is a weighted mean of, by their weights. Displacements are vectors of a motion.
class Pull {
 public:
  struct Entry {
    Eigen::Index at; ///< in a vector
    double weight;
    bool is_free; ///< whether a force acts on it; what is constrained counts for the place alone
  };
  using Entries = std::array<std::vector<Entry>, 3>; ///< by component

  /// @param stiffness  N/mm, > 0
  Pull(Entries entries, double stiffness) : entries_(std::move(entries)), stiffness_(stiffness) {}

  /// @param target  displacement that the place is drawn to, mm
  void draw_to(const Eigen::Vector3d& target) { target_ = target; }

  double stiffness() const { return stiffness_; }
  /// Displacement of the place, mm.
  template<class Real>
  Eigen::Vector3d place(const VectorIn<Real>& displacement) const;
  Eigen::Vector3d force(const Vector& displacement) const {
    return stiffness_ * (target_ - place(displacement));
  }

  /// stiffness |target - place(u)|²/2, N mm
  double energy(const Vector& displacement) const {
    return stiffness_ / 2 * (target_ - place(displacement)).squaredNorm();
  }
  /// Adds to `to`: to += force(u) . weights, N
  void add_force(const Vector& displacement, Vector& to) const { add(force(displacement), to); }
  /// Norm of these forces, N.
  double size(const Vector& displacement) const;
  /// Its tangent, of rank three: to += stiffness weights (weights . direction).
  template<class Real>
  void add_product(const VectorIn<Real>& direction, VectorIn<Real>& to) const {
    add(stiffness_ * place(direction), to);
  }

  /// Adds the force on free degrees of freedom to `to`, by the weights.
  template<class Real>
  void add(const Eigen::Vector3d& force, VectorIn<Real>& to) const;

  const Entries& entries() const { return entries_; }

 private:
  Entries entries_;
  double stiffness_;
  Eigen::Vector3d target_ = Eigen::Vector3d::Zero(); ///< mm
};

/// The inverse of a matrix with the tangent of a pull added, from the inverse without it (Woodbury's
/// formula):
///   (A + k W W^T)^-1 r = z - Y (1/k + W^T Y)^-1 W^T z,  z = A^-1 r,  Y = A^-1 W.
template<class Real>
class WithPull {
 public:
  /// @param invert  (right side, solution) by A, which is symmetric and positive definite
  /// @param size    size of a vector
  void prepare(const Pull& pull, Eigen::Index size,
               const std::function<void(const VectorIn<Real>&, VectorIn<Real>&)>& invert);
  /// Whether the pull makes its place more than twice as stiff; what it does else, conjugate gradients find.
  bool matters() const { return matters_; }
  /// @param solution  by A, becomes that with the pull
  void correct(const Pull& pull, VectorIn<Real>& solution) const;

 private:
  std::array<VectorIn<Real>, 3> columns_;             ///< Y
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero(); ///< inverse of 1/k + W^T Y
  bool matters_ = false;
  VectorIn<Real> unit_;
};

} // namespace springproof::msm
