#pragma once

#include "msm/direct/direct_system.hpp"

/// Entries of the direct system's vectors, and the points that they belong to.
namespace springproof::msm {

/// Calls action(point, component, place in a vector): free degrees of freedom, and then, if supports move,
/// constrained ones.
template<class Action>
void for_each_entry(const Problem& problem, const Action& action) {
  Eigen::Index next = 0;
  for (const bool constrained : {false, true}) {
    if (constrained && !problem.supports) return;
    for (std::size_t d = 0; d < problem.is_constrained.size(); ++d)
      if (problem.is_constrained[d] == constrained) action(d / 3, static_cast<int>(d % 3), next++);
  }
}

/// Values of points as a vector of the direct system, 0 on constrained degrees of freedom.
inline Vector on_free(const Problem& problem, const Points& points) {
  Vector all = to_vector(problem, points);
  all.tail(all.size() - static_cast<Eigen::Index>(n_unknowns(problem))).setZero();
  return all;
}

/// Positions at a displacement, mm.
inline Points positions(const Problem& problem, const Vector& displacement) {
  Points moved = to_points(problem, displacement);
  for (std::size_t p = 0; p < moved.size(); ++p) moved[p] += problem.lattice.rest[p];
  return moved;
}

} // namespace springproof::msm
