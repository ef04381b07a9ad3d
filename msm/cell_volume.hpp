#pragma once

#include <Eigen/Core>
#include <array>

namespace springproof::msm {

using CellPositions = std::array<Eigen::Vector3d, 8>; ///< mm, vertex v = i + 2j + 4k

/// Volume of the trilinear hexahedron, mm³, and its derivatives. It is a cubic form of the vertices,
///   V = 1/6 sum_abc T_abc x_a . (x_b x x_c),
/// with T constant and antisymmetric, so that all three are exact. The volume under a bilinear face a, b, c,
/// d, anticlockwise from outside, is the mean of what its two triangulations give: it adds (b x c + c x d + b
/// x d) / 12 to the derivative with respect to a.
double trilinear_volume(const CellPositions& x);

/// dV/dx_a, mm².
std::array<Eigen::Vector3d, 8> trilinear_volume_gradient(const CellPositions& x);

/// d²V/(dx_a dx_b) as 3x3 blocks [a][b], mm: entry (i, j) = epsilon_ijk (sum_c T_abc x_c)_k.
std::array<std::array<Eigen::Matrix3d, 8>, 8> trilinear_volume_second_derivative(const CellPositions& x);

} // namespace springproof::msm
