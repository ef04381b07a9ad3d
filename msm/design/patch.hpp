#pragma once

#include "msm/design/cells.hpp"

#include <Eigen/SparseCore>

/// What the springs of a body of any cells can do at rest, before anything is loaded or held.
namespace springproof::msm {

/// Energy of a cell's terms under affine displacements per rest volume: twice the energy is e^T C e. A volume
/// term at the nodes counts as the cell's.
Elasticity cell_elasticity(const CellTerms& terms, const cases::CellCorners& corners);

/// What a spring adds to it times the volume, N mm.  @param d  the vector between its ends, mm
Elasticity spring_elasticity(const Eigen::Vector3d& d, double stiffness);

/// Distance of a lattice's energies of strains from a material's: the root mean square over strains and their
/// pairs, |S (C_k - C) S|/√6 with S = C^(-1/2), whose strains have the energy 1 in the material.
/// @param material  positive definite
double strain_misfit(const Elasticity& lattice, const Elasticity& material);

/// The energy of uniform strains that points give up where they are free, as an elasticity matrix:
///   f^T K^-1 f / V,  f the forces on the free points under the six strains, K their stiffness.
struct Relaxation {
  Elasticity released = Elasticity::Zero();
  bool is_stable = true; ///< K has no negative eigenvalue, whose energy would fall without end
};

/// @param is_free  one entry per point; the others follow the strain    @param volume  mm³
Relaxation relax(const Lattice& lattice, const std::vector<bool>& is_free, double volume);

/// The stiffness of a lattice at rest without supports, both triangles, N/mm: degree of freedom
/// 3*point + component.
Eigen::SparseMatrix<double> free_stiffness(const Lattice& lattice);

/// Motions without stiffness that are no rigid motions.
struct ZeroModes {
  int n = 0;              ///< how many
  std::vector<int> nodes; ///< those that move in any of them, seen from most of the points
};

/// @param null_space  orthonormal columns, degree of freedom 3*point + component: all motions of the points
/// that take no energy
ZeroModes zero_modes(const Points& points, const Eigen::MatrixXd& null_space);

} // namespace springproof::msm
