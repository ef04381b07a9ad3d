#pragma once

#include "msm/moving_springs.hpp"
#include "msm/spring_memory.hpp"

#include <memory>

namespace springproof::msm {

/// The equations of any lattice: assembled sparse tangent, factorised by CHOLMOD. Vectors have one
/// entry per free degree of freedom, points in order and components together.
/// @param problem  must outlive the system
std::unique_ptr<SpringSystem> make_direct_system(const Problem& problem);

/// The motion of any lattice: the tangent of a step assembled and factorised by CHOLMOD.
/// @param problem  made by make_moving_problem(), with its lattice; must outlive the result, as must springs
/// @param springs  make_direct_system(problem)
/// @param memory   of the problem's lattice; null: it has none
std::unique_ptr<MovingSprings> make_moving_lattice(const Problem& problem, SpringSystem& springs,
                                                   const Inertia& inertia,
                                                   std::unique_ptr<SpringMemory> memory = nullptr);

/// Converts between vectors of a direct system and one displacement (mm) per point.
Points to_points(const Problem& problem, const Vector& free);
Vector to_vector(const Problem& problem, const Points& points);

} // namespace springproof::msm
