#pragma once

#include "cases/case/case.hpp"

#include <Eigen/Core>
#include <array>

namespace springproof::fem_reference {

using ElementStiffness = Eigen::Matrix<double, 24, 24>;

/// Stiffness matrix of one trilinear hexahedron at rest, N/mm; degree of freedom 3*vertex + component,
/// vertices in the order of Mesh::cells.  K = integral of B^T D B (thesis eq. 4.7), 2x2x2 Gauss; q1_bbar
/// replaces the volumetric part of B by its element mean.
/// @param vertices  mm     @param element  q1 or q1_bbar
/// @throws InputError for another element, or for nu outside (-1, 0.5)
ElementStiffness element_stiffness(const std::array<Eigen::Vector3d, 8>& vertices,
                                   const cases::LinearElastic& material, cases::Element element);

} // namespace springproof::fem_reference
