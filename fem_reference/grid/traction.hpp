#pragma once

#include "cases/scene/loads.hpp"

#include <array>

namespace springproof::fem_reference::grid {

/// Forces (N) on the nodes of a rectangle, (a, b) in [a + 3 b].
using NineForces = std::array<Eigen::Vector3d, 9>;

/// Integrals of a traction times the nine shape functions of a rectangle. Vertices anticlockwise, mm; node
/// (a, b) is a halves of the first edge and b of the last one from the first vertex.
/// @param moment  polar moment of the load's region, as surface_traction() wants it
NineForces traction_on(const cases::Scene::AppliedLoad& applied,
                       const std::array<Eigen::Vector3d, 4>& vertices, double moment);

} // namespace springproof::fem_reference::grid
