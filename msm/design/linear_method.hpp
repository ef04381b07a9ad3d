#pragma once

#include "msm/design/lattice_moduli.hpp"
#include "msm/spring_body.hpp"

namespace springproof::msm {

/// Degree of freedom 3*vertex + component, vertex v = i + 2j + 4k.
using CellMatrix = Eigen::Matrix<double, 24, 24>;

/// Stiffness matrix of one cell, its tangent at rest (N/mm). Springs have
///   K_ii = sum_j k_ij n n^T,  K_ij = -k_ij n n^T,  n the unit vector along the spring,
/// the volume term (k_v/V0) g g^T with g = dV/dx.  Source: thesis eqs 4.12, 4.13.
/// @param vertices  rest positions, mm
CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms);
inline CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellStiffness& stiffness) {
  return cell_stiffness_matrix(vertices, terms_of(stiffness));
}

struct LinearFit {
  CellStiffness stiffness; ///< without a volume term
  double residual;         ///< || K_FEM - K_MSM ||_F, N/mm
};

/// The linear method: the k_e, k_f, k_d >= 0 that minimise the distance of K_MSM from a reference matrix in
/// the Frobenius norm.
/// @param reference  symmetric 24x24 stiffness matrix of the same cell, N/mm    @param vertices  any
/// hexahedron, mm Source: thesis eq. 4.15, the same minimiser as eq. 4.19.
LinearFit linear_method(const CellMatrix& reference, const CellVertices& vertices);

/// k' of thesis eq. 4.21, k = (L0/2) k' E: dimensionless, depends on Poisson's ratio alone.
/// @param youngs_modulus  MPa    @param edge  L0, mm
CellStiffness pseudo_stiffness(const CellStiffness& stiffness, double youngs_modulus, double edge);

} // namespace springproof::msm
