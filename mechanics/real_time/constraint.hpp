#pragma once

#include <algorithm>
#include <cstddef>

namespace springproof::mechanics {

/// Derivatives U' and U'' of a constraint's energy by its number C.
struct ConstraintEnergy {
  double force, slope;
};

/// A projection with a multiplier lambda = -U'(C), which Newton's method for one constraint after the other
/// finds:
///   d lambda = -(U' + lambda)/(1 + U'' w),  w = grad C . D^-1 grad C,  dx = D^-1 grad C d lambda.
/// For U = k C²/2 that is the update of Macklin et al. (2016), eq. 18, of compliance 1/k, times D in place of
/// M/h². A constraint whose energy curves down takes the first part of 1 alone.
/// @param gradient  dC/dx of the n-th of its nodes as a function of n
/// @param moved_by  D^-1 of a vector of that node, (n, vector)
/// @param move      moves that node, (n, by)
template<class Gradient, class MovedBy, class Move>
void project(std::size_t n_nodes, const ConstraintEnergy& energy, const Gradient& gradient,
             const MovedBy& moved_by, double& multiplier, const Move& move) {
  double weight = 0;
  for (std::size_t n = 0; n < n_nodes; ++n) weight += gradient(n).dot(moved_by(n, gradient(n)));
  if (weight == 0) return; // between supports
  const double change = -(energy.force + multiplier) / (1 + std::max(energy.slope, 0.) * weight);
  multiplier += change;
  for (std::size_t n = 0; n < n_nodes; ++n) move(n, moved_by(n, change * gradient(n)));
}

} // namespace springproof::mechanics
