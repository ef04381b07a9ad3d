#pragma once

#include <Eigen/Core>
#include <array>

namespace springproof::msm {

using CellPositions = std::array<Eigen::Vector3d, 8>; ///< mm, vertex v = i + 2j + 4k
using CellGradient = std::array<Eigen::Vector3d, 8>;

/// Volume of the trilinear hexahedron, mm³, and its derivatives. It is a cubic form of the vertices,
///   V = 1/6 sum_abc T_abc x_a . (x_b x x_c),  T_abc = integral of grad N_a . (grad N_b x grad N_c) over the
///   unit cube,
/// with T constant and antisymmetric, so that all three are exact.
double trilinear_volume(const CellPositions& x);

/// dV/dx_a = 1/2 sum_bc T_abc x_b x x_c, mm².
CellGradient trilinear_volume_gradient(const CellPositions& x);

/// d²V/(dx_a dx_b) as a 3x3 block, mm: entry (i, j) = epsilon_ijk (sum_c T_abc x_c)_k.
Eigen::Matrix3d trilinear_volume_second_derivative(const CellPositions& x, int a, int b);

} // namespace springproof::msm
