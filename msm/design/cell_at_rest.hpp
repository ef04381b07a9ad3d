#pragma once

#include "msm/spring_body.hpp"

#include <optional>
#include <string>

/// Cells at rest: their stiffness, the moduli of the infinite lattice of such cells, and whether they can be
/// trusted.
namespace springproof::msm {

using CellVertices = CellPositions; ///< vertices of a cell at rest
/// Degree of freedom 3*vertex + component, vertex v = i + 2j + 4k.
using CellMatrix = Eigen::Matrix<double, 24, 24>;

/// Cube from the origin to (edge, edge, edge), mm.
CellVertices cube(double edge);

/// Edge of a cubical cell aligned with the axes, mm; 0 when the cell is another hexahedron (to 1e-9 of its
/// edge).
double cube_edge(const CellVertices& vertices);

/// Stiffness matrix of one cell, its tangent at rest (N/mm). Springs have
///   K_ii = sum_j k_ij n n^T,  K_ij = -k_ij n n^T,  n the unit vector along the spring,
/// the volume term (k_v/V0) g g^T with g = dV/dx.  Source: thesis eqs 4.12, 4.13.
/// @param vertices  rest positions, mm
CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellTerms& terms);
inline CellMatrix cell_stiffness_matrix(const CellVertices& vertices, const CellStiffness& stiffness) {
  return cell_stiffness_matrix(vertices, terms_of(stiffness));
}

/// MPa; engineering strains in the order xx, yy, zz, yz, xz, xy.
using Elasticity = Eigen::Matrix<double, 6, 6>;

/// Energy of cells under affine displacements as an elasticity matrix: twice the energy per rest volume is
/// e^T C e. The mean of the cells' kinds.
Elasticity cell_elasticity(const std::vector<CellTerms>& kinds, const CellVertices& vertices);
inline Elasticity cell_elasticity(const CellStiffness& stiffness, const CellVertices& vertices) {
  return cell_elasticity(std::vector{terms_of(stiffness)}, vertices);
}

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

/// C11, C12 and C44 averaged over the three axes. Of cell_elasticity() they are exact for a parallelepiped,
/// and where the points of the lattice are centres of symmetry, as those of the cut cells are; for another
/// hexahedron they are the affine (Voigt) estimate.
LatticeModuli averaged_moduli(const Elasticity& elasticity);

/// Derived ratios from the three constants of a cubic solid (MPa).
LatticeModuli cubic_moduli(double c11, double c12, double c44);

/// Eigenvalues of a cell's tangent at rest that are no round-off.
struct Signs {
  Eigen::Index n_negative, n_zero;
};

Signs signs_at_rest(const CellMatrix& matrix);

/// Reasons not to trust cells whose kinds are mirror images: negative stiffnesses, a mechanism (more than the
/// six rigid modes), an indefinite tangent at rest.
std::vector<std::string> examine(const CellTerms& terms, const CellVertices& vertices);

/// How far a lattice's small-strain moduli are from its material's.
struct ModuliMisfit {
  /// Largest error of the engineering constants by axis: |E_lattice/E - 1|, |G_lattice/G - 1|, and
  /// |nu_lattice - nu|, the error of a uniaxial test's lateral strain as a part of its axial strain. Infinite
  /// when some strain has no energy.
  double largest;
  std::string text; ///< both sets of constants, in a sentence
};

/// What is told of: a body's error follows its moduli's one to one, and 5 % is what a mesh may err by.
constexpr double told_moduli_misfit = 0.05;

/// @param lattice  MPa    @param material  MPa, positive definite
ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material);

} // namespace springproof::msm
