#pragma once

#include <Eigen/Core>
#include <functional>

namespace springproof::mechanics {

struct LargestMode {
  double eigenvalue;
  Eigen::VectorXd shape; ///< of length 1
};

/// Largest eigenvalue of a symmetric operator and its eigenvector, by Lanczos with full reorthogonalisation
/// from a fixed pseudo-random vector: to 1e-6 relative, or what 60 steps give.
LargestMode largest_mode(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& apply, Eigen::Index n);

} // namespace springproof::mechanics
