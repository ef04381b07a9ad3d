#pragma once

#include "msm/spring_body.hpp"

#include <optional>
#include <string>

/// Cells at rest: their stiffness, the moduli of the infinite lattice of such cells, and whether they can be
/// trusted.
///
/// The infinite lattice of equal cubes under a homogeneous deformation gradient F: thirteen springs per node
/// and the volume term. Every node is a centre of symmetry, so that an affine deformation is in equilibrium
/// and the energy is a closed form.
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

/// Misfit from which on a warning is given. A body's error is about that of its moduli, and 5 % is what a
/// mesh may err by.
constexpr double told_moduli_misfit = 0.05;

/// @param lattice  MPa    @param material  MPa, positive definite
ModuliMisfit moduli_misfit(const Elasticity& lattice, const Elasticity& material);

/// Energy per rest volume, MPa:
///   W = (1/h³) sum over the 13 springs of K/2 (|F d| - |d|)² + k_v/2 (det F - 1)²
/// (or the power-log law's integrals),
/// with assembled K_e = 4 k_e, K_f = 2 k_f, K_d = k_d.  @param edge  h, mm
double lattice_energy_density(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// First Piola-Kirchhoff stress dW/dF, MPa.
Eigen::Matrix3d lattice_stress(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// Simple shear of xz by an amount.
Eigen::Matrix3d simple_shear(double amount);

/// Smallest eigenvalue of the dynamical matrix D(q) divided by |q h|², N/mm, over wave vectors q of the first
/// Brillouin zone. Positive: no small displacement of the infinite lattice, of any wavelength, lowers its
/// energy.
double smallest_wave_stiffness(const CellStiffness& stiffness, double edge, const Eigen::Matrix3d& f);

/// How far a homogeneous lattice can be deformed before some wave loses its stiffness.
struct StabilityRange {
  double stretch; ///< largest stable l of uniaxial stretch with free sides; the search's end when stable to
                  ///< there
  double compression; ///< smallest stable l
  double shear;       ///< largest stable simple shear
};

/// The ends of the search, where a lattice counts as stable without limit.
constexpr StabilityRange search_ends = {3.0, 0.3, 2.0};

/// Found by walking along each path in steps of 2 % and bisecting the first step that is unstable, to 1e-4.
StabilityRange stability_range(const CellStiffness& stiffness, double edge);

/// Stretch of the sides at which they are free of stress, under an axial stretch along z.
/// @throws SolveError when there is none
double free_lateral_stretch(const CellStiffness& stiffness, double edge, double axial_stretch);

/// Whether the infinite lattice has no unstable wave at either end of the strains, in uniaxial tests along an
/// axis.
bool is_stable_over(const std::array<double, 2>& strain_range, const CellStiffness& stiffness, double edge);

} // namespace springproof::msm
