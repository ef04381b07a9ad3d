#pragma once

#include "cases/case/dynamics.hpp"

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace springproof::mechanics {

/// A load of a motion: forces on some entries of a vector, and how much of them acts when. A replay has
/// hundreds, each of a few nodes.
class LoadInTime {
 public:
  /// @param force  N, at a factor of 1; 0 on constrained degrees of freedom
  LoadInTime(cases::History history, const Eigen::VectorXd& force) : history_(std::move(history)) {
    for (Eigen::Index i = 0; i < force.size(); ++i)
      if (force[i] != 0) force_.emplace_back(i, force[i]);
  }
  /// force += the load at a time (s), N
  void add(double time, Eigen::VectorXd& force) const {
    const double factor = history_.at(time);
    if (factor == 0) return;
    for (const auto& [entry, at_full] : force_) force[entry] += factor * at_full;
  }

 private:
  cases::History history_;
  std::vector<std::pair<Eigen::Index, double>> force_;
};

} // namespace springproof::mechanics
