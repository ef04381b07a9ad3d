#pragma once

#include "msm/spring_body.hpp"

namespace springproof::msm {

using CellVertices = CellPositions; ///< of a cell at rest

/// Small-strain moduli of the infinite lattice of equal cells, MPa (ratios are plain numbers).
struct LatticeModuli {
  double c11 = 0, c12 = 0, c44 = 0;
  double zener = 0;          ///< 2 C44 / (C11 - C12); 1 when isotropic
  double youngs_modulus = 0; ///< along a lattice axis, C11 - 2 C12² / (C11 + C12)
  double poissons_ratio = 0; ///< stretched along a lattice axis, C12 / (C11 + C12)
  double shear_modulus = 0;  ///< between lattice axes, C44
};

/// Moduli of the lattice of cubes. With assembled stiffnesses K_e = 4 k_e, K_f = 2 k_f, K_d = k_d:
///   C11 = (K_e + 2 K_f + 4 K_d/3)/h + k_v,  C44 = (K_f + 4 K_d/3)/h,  C12 = C44 + k_v.
/// Exact: an affine displacement leaves every point of the lattice in equilibrium, each being a centre of
/// symmetry.
/// @param edge  h, mm, > 0
LatticeModuli lattice_moduli(const CellStiffness& stiffness, double edge);

/// MPa; engineering strains in the order xx, yy, zz, yz, xz, xy.
using Elasticity = Eigen::Matrix<double, 6, 6>;

/// Energy of cells under affine displacements as an elasticity matrix: twice the energy per rest volume is
/// e^T C e. The mean of the cells' kinds.
Elasticity cell_elasticity(const std::vector<CellTerms>& kinds, const CellVertices& vertices);
inline Elasticity cell_elasticity(const CellStiffness& stiffness, const CellVertices& vertices) {
  return cell_elasticity(std::vector{terms_of(stiffness)}, vertices);
}

/// C11, C12 and C44 averaged over the three axes. Of cell_elasticity() they are exact for a parallelepiped,
/// and where the points of the lattice are centres of symmetry, as those of the cut cells are; for another
/// hexahedron they are the affine (Voigt) estimate.
LatticeModuli averaged_moduli(const Elasticity& elasticity);

/// Derived ratios from the three constants of a cubic solid (MPa).
LatticeModuli cubic_moduli(double c11, double c12, double c44);

/// Edge of a cubical cell aligned with the axes, mm; 0 when the cell is another hexahedron (to 1e-9 of its
/// edge).
double cube_edge(const CellVertices& vertices);

/// Cube from the origin to (edge, edge, edge), mm.
CellVertices cube(double edge);

} // namespace springproof::msm
