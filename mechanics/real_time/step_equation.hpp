#pragma once

#include "mechanics/real_time/pull_of_points.hpp"

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

/// How simulators make a step in time of points with lumped masses, whatever acts between them.
namespace springproof::mechanics {

using Points = std::vector<Eigen::Vector3d>; ///< one per point: mm or N

/// The equation of a step,  D (u - origin) = force + f_int(u) + pull(u),  by points.
struct StepEquation {
  Points inertia; ///< D, N/mm: M/h² + C/h, lumped; 0 on constrained components
  Points origin;  ///< mm: displacement when the step begins
  Points force;   ///< N: loads, and the inertia of the velocity
  std::optional<PullOfPoints> pull{};

  /// D^-1 of a point's vector, 0 on constrained components.
  Eigen::Vector3d moved_by(std::size_t point, const Eigen::Vector3d& by) const {
    const Eigen::Vector3d& d = inertia[point];
    return (d.array() > 0).select(by.cwiseQuotient(d), 0);
  }
  /// Where the points go without internal forces: supports of `at` stay.
  void go_freely(Points& at) const {
    for (std::size_t p = 0; p < at.size(); ++p)
      at[p] = (inertia[p].array() > 0).select(origin[p] + moved_by(p, force[p]), at[p]);
  }
  /// What is left of the equation, N, without internal forces and pull.
  Eigen::Vector3d rest_of(std::size_t point, const Eigen::Vector3d& displacement) const {
    return (inertia[point].array() > 0)
        .select(force[point] - inertia[point].cwiseProduct(displacement - origin[point]), 0);
  }
};

/// Goes from where the step begins to the method's answer: `at`, mm, whose constrained components are where
/// the step has them. Called for one step of a motion after the other, all of one length.
/// @return iterations
using MakeStep = std::function<int(const StepEquation& step, Points& at)>;

/// Message of a step whose residual is not finite.
constexpr const char* no_finite_place = "steps in real time: a node is at no finite place, or a cell is "
                                        "turned inside out that has no forces then";

/// Internal forces at a displacement (mm), N.
using ForcesAt = std::function<Points(const Points& displacement)>;

} // namespace springproof::mechanics
