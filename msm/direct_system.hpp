#pragma once

#include "msm/equilibrium.hpp"
#include "msm/tangent.hpp"

#include <memory>

namespace msm {

/// A lattice that is held and loaded.
struct Problem {
  cases::HexMesh mesh;
  Lattice lattice;
  Points force;               ///< applied at full load, N, one per point
  std::vector<bool> is_fixed; ///< degree of freedom 3*point + component stays at rest
};

/// Any lattice as Newton's method sees it: assembled sparse tangent, factorised by CHOLMOD. Vectors have one
/// entry per free degree of freedom, points in order and components together.
/// @param problem  must outlive the system
std::unique_ptr<EquilibriumSystem> make_direct_system(const Problem& problem);

/// Between vectors of a direct system and one displacement (mm) per point.
Points to_points(const Problem& problem, const Vector& free);
Vector to_vector(const Problem& problem, const Points& points);

} // namespace msm
