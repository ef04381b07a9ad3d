#pragma once

#include "msm/design/cells.hpp"

/// Closed forms that tests hold designs against.
namespace springproof::closed {

/// Moduli of the lattice of cubes. With assembled stiffnesses K_e = 4 k_e, K_f = 2 k_f, K_d = k_d:
///   C11 = (K_e + 2 K_f + 4 K_d/3)/h + k_v,  C44 = (K_f + 4 K_d/3)/h,  C12 = C44 + k_v.
/// Exact: an affine displacement leaves every point of the lattice in equilibrium, each being a centre of
/// symmetry.
/// @param edge  h, mm, > 0
inline msm::LatticeModuli lattice_moduli(const msm::CellStiffness& stiffness, double edge) {
  const double edges = 4 * stiffness.edge;
  const double face_diagonals = 2 * stiffness.face_diagonal;
  const double internal_diagonals = 4 * stiffness.internal_diagonal / 3;
  const double c44 = (face_diagonals + internal_diagonals) / edge;
  const double c11 = (edges + 2 * face_diagonals + internal_diagonals) / edge + stiffness.volume;
  return msm::cubic_moduli(c11, c44 + stiffness.volume, c44);
}

/// k' of thesis eq. 4.21, k = (L0/2) k' E: dimensionless, depends on Poisson's ratio alone.
/// @param youngs_modulus  MPa    @param edge  L0, mm
inline msm::CellStiffness pseudo_stiffness(const msm::CellStiffness& stiffness, double youngs_modulus,
                                           double edge) {
  const double unit = youngs_modulus * edge / 2;
  msm::CellStiffness pseudo = scaled(stiffness, 1 / unit);
  pseudo.volume = stiffness.volume / youngs_modulus;
  return pseudo;
}

} // namespace springproof::closed
