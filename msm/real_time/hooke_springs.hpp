#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace springproof::msm {

/// A point's position or mobility. The fourth entry is 0, so that a point is loaded whole, and none lies
/// across two lines of a cache.
struct alignas(32) WholePoint : Eigen::Vector4d {
  using Eigen::Vector4d::Vector4d;
};
using WholePoints = std::vector<WholePoint>;

/// Hooke's springs that have no node in common, with their multipliers.
struct alignas(32) FourSprings {
  double stiffness[4], rest_length[4], multiplier[4]; // N/mm, mm, N
  double mobility[2][4]; ///< nodes' D^-1, mm/N, where it is the same in all directions
  int nodes[2][4];
};

/// The general projection (mechanics/real_time/constraint.hpp) of n times four springs with C = l, whose two
/// quotients by l and 1 + U'' w are one.
/// @param x         positions, mm
/// @param is_first  takes the multipliers for 0, whatever they are
void project(FourSprings* springs, std::ptrdiff_t n, bool is_first, WholePoints& x);
/// The same where nodes are free to move in some directions alone.
/// @param mobility  D^-1, mm/N
void project(FourSprings* springs, std::ptrdiff_t n, bool is_first, WholePoints& x,
             const WholePoints& mobility);

} // namespace springproof::msm
