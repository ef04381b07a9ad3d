#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace springproof::mechanics {

/// A spring between a weighted mean of points and a place outside of the body:
/// force = stiffness (target - mean), on the points by their weights.
struct PullOfPoints {
  using Points = std::vector<Eigen::Vector3d>;
  std::vector<std::pair<std::size_t, double>> weights; ///< by points, of sum 1
  double stiffness;                                    ///< N/mm
  Eigen::Vector3d target;                              ///< mm

  Eigen::Vector3d mean(const Points& of) const;
  Eigen::Vector3d force(const Points& displacement) const {
    return stiffness * (target - mean(displacement));
  }
  /// Whether another pull has the same stiffness and points, whatever its target.
  bool is_at_place_of(const std::optional<PullOfPoints>& other) const {
    return other && other->stiffness == stiffness && other->weights == weights;
  }
  /// Its tangent: out += stiffness weights (weights . in).
  /// @param number  of a degree of freedom 3*point + component in the vectors, or -1
  void add_product(const std::vector<int>& number, const Eigen::VectorXd& in, Eigen::VectorXd& out) const;
};

/// Projects a pull as a constraint of three numbers, as XPBD does a spring. Beside inertia alone it is solved
/// then.
/// @param moved_by  (point, force) -> mm: D^-1 of a step's equation
/// @param force     N: what pulls at `at`, and afterwards what has pulled to there
void project_pull(const PullOfPoints& pull,
                  const std::function<Eigen::Vector3d(std::size_t, const Eigen::Vector3d&)>& moved_by,
                  Eigen::Vector3d& force, PullOfPoints::Points& at);

} // namespace springproof::mechanics
