#pragma once

#include <Eigen/Core>

namespace springproof::mechanics {

/// What Coulomb's law knows of a point of the surface while an equilibrium or a step is looked for.
struct Grip {
  Eigen::Vector3d anchor = Eigen::Vector3d::Zero();  ///< mm, as seen from the tool: where the last step ended
  Eigen::Vector3d held = Eigen::Vector3d::Zero();    ///< N: the friction there; in statics a multiplier
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(); ///< unit normal of the plane in which it acts
  double bound = 0;                                  ///< N: coefficient times the force along the normal
};

/// The friction at a point.
struct Friction {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< on the body, N
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(); ///< N/mm, symmetric, >= 0
  double energy = 0;                                   ///< N mm: minus its slope by the place is the force
};

/// The law with its bound and plane held: with P = 1 - n n^T and the slide s = P (x - anchor) the force is
/// q = P held - k s, and where that is above the bound b it is b q/|q|: a point sticks by a stiff spring, or
/// slips. Its potential is |q|²/(2k), or b |q|/k - b²/(2k); it is convex, and its second derivative, the
/// stiffness, is exact: k P, or k b/|q| (P - q q^T/|q|²). Coulomb's own stiffness has in addition how the
/// bound follows the pressure and the plane the normal, is not symmetric, and is left out. Bound and plane
/// are brought to the pressures between solutions instead, until they agree.
/// Source: T. A. Laursen and J. C. Simo, Algorithmic symmetrization of Coulomb frictional problems using
/// augmented Lagrangians, Computer Methods in Applied Mechanics and Engineering 108 (1993).
/// @param stiffness  k, N/mm    @param from_tool  x, the point as seen from the tool's place, mm
inline Friction friction(const Grip& grip, double stiffness, const Eigen::Vector3d& from_tool) {
  if (!(grip.bound > 0)) return {};
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - grip.normal * grip.normal.transpose();
  const Eigen::Vector3d trial = plane * (grip.held - stiffness * (from_tool - grip.anchor));
  const double size = trial.norm();
  if (size <= grip.bound) return {trial, stiffness * plane, size * size / (2 * stiffness)};
  const Eigen::Vector3d along = trial / size;
  return {grip.bound * along, stiffness * grip.bound / size * (plane - along * along.transpose()),
          grip.bound * (size - grip.bound / 2) / stiffness};
}

} // namespace springproof::mechanics
