#pragma once

#include "msm/design/lattice_moduli.hpp"

namespace springproof::msm {

/// Springs of a cubical lattice with the given Young's modulus along its axes and shear modulus between them:
///   C12 = C44 = G,  C11 = ((E - G) + sqrt((E + G)² + 8 G²))/2,  which is C11 - 2 C12²/(C11 + C12) = E
///   solved; 4 K_d/3 = t G h,  K_f = (1 - t) G h,  K_e = C11 h - 2 K_f - 4 K_d/3.
/// Poisson's ratio follows: C12/(C11 + C12).
/// @param youngs_modulus  E, MPa, > 0    @param shear_modulus  G, MPa, > 0
/// @param split  t, in [0, 1]: the internal diagonals' share of the shear stiffness
/// @param edge   h, mm, > 0
CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split, double edge);

/// Springs and a cell volume term whose cubical lattice is isotropic with the given Lamé constants, exactly:
///   4 K_d/3 = t mu h,  K_f = (1 - t) mu h,  K_e = K_f + 8 K_d/3,  k_v = lambda - mu.
/// k_v is negative below nu = 1/4, where lambda < mu.
/// @param lame_lambda, lame_mu  MPa, lame_mu > 0    @param split, edge  as for moduli_method()
CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, double edge);

/// The two methods for a cell that is not a cube: the k_e and the shear stiffness m >= 0, divided by the
/// split into k_f = (1 - t) m/2 and k_d = 3 t m/4, whose elasticity matrix is nearest (Frobenius norm) to the
/// cubic one with C11 and C12 = C44 = G of the closed form. In a cube that is the closed form itself.
/// @param vertices  any hexahedron, mm
CellStiffness moduli_method(double youngs_modulus, double shear_modulus, double split,
                            const CellVertices& vertices);
CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, const CellVertices& vertices);

} // namespace springproof::msm
