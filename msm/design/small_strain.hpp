#pragma once

#include "msm/design/cell_at_rest.hpp"

/// Designs from a material at small strains: the linear method, the moduli method and the hybrid method.
namespace springproof::msm {

/// Small-strain E and nu of a material: Ogden's initial shear modulus is the sum of mu, and nu = 0.5 without
/// a bulk modulus.
cases::LinearElastic small_strain_material(const cases::Material& material);

/// The elasticity of a material at rest; nothing for a fibre that lies along no axis, and where E is not
/// above 0.
std::optional<Elasticity> elasticity_at_rest(const cases::Material& material);

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

/// The k_e and the shear stiffness m >= 0, divided by the split into k_f = (1 - t) m/2 and k_d = 3 t m/4,
/// whose elasticity matrix is nearest (Frobenius norm) to the cubic one with the given Young's modulus along
/// the axes and shear modulus between them:
///   C12 = C44 = G,  C11 = ((E - G) + sqrt((E + G)² + 8 G²))/2,  which is C11 - 2 C12²/(C11 + C12) = E
///   solved.
/// A cube of edge h meets it: 4 K_d/3 = t G h,  K_f = (1 - t) G h,  K_e = C11 h - 2 K_f - 4 K_d/3 with
/// the assembled K_e = 4 k_e, K_f = 2 k_f, K_d = k_d. Poisson's ratio follows: C12/(C11 + C12).
/// @param youngs_modulus  E, MPa, > 0    @param shear_modulus  G, MPa, > 0
/// @param split     t, in [0, 1]: the internal diagonals' share of the shear stiffness
/// @param vertices  any hexahedron, mm
CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split,
                            const CellVertices& vertices);

/// That C11.
double c11_of_springs(double youngs_modulus, double shear_modulus);

/// Springs and a cell volume term nearest to the isotropic elasticity with the given Lamé constants, which
/// they meet in a cube: C11 = 3 mu and C12 = C44 = mu of the springs, so that K_e = K_f + 8 K_d/3, and k_v =
/// lambda - mu, which is negative below nu = 1/4, where lambda < mu.
/// @param lame_lambda, lame_mu  MPa, lame_mu > 0    @param split, vertices  as for moduli_method()
CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, const CellVertices& vertices);

} // namespace springproof::msm
