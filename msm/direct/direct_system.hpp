#pragma once

#include "msm/problem.hpp"

#include <memory>

namespace springproof::msm {

/// The equations of any lattice: assembled sparse tangent, factorised by CHOLMOD. Vectors have one
/// entry per free degree of freedom, points in order and components together.
/// @param problem  must outlive the system
std::unique_ptr<SpringSystem> make_direct_system(const Problem& problem);

/// Between vectors of a direct system and one displacement (mm) per point.
Points to_points(const Problem& problem, const Vector& free);
Vector to_vector(const Problem& problem, const Points& points);

} // namespace springproof::msm
