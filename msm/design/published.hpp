#pragma once

#include "msm/lattice.hpp"

/// Springs of cubical cells that others published: points of the family of k_e, k_f, k_d and k_v, in which an
/// interior edge has 4 k_e, an interior face diagonal 2 k_f. @param edge  of the cell, mm, > 0
namespace springproof::msm {

/// Edges and face diagonals of one stiffness inside the body, 2 E a/5: isotropic with E and nu = 1/4,
/// whatever the material's.  @param youngs_modulus  MPa, > 0 Source: Ladd & Kinney 1997; Kot, Nagahashi &
/// Szymczak 2015, Vis Comput 31:1339.
CellStiffness ladd_kinney(double youngs_modulus, double edge);

/// Edges and internal diagonals: k_d = 3 E a/(8 (1 + nu)), k_e = E a (4 nu + 1)/(8 (1 + nu)). Isotropic at
/// nu = 1/4, where the published lateral correction force sigma (4 nu - 1)/2, which has no energy and is not
/// here, vanishes.  @param poissons_ratio  >= -1/4
/// Source: Baudet, Beuve, Jaillet, Shariat & Zara 2009, hal-00994456.
CellStiffness baudet(double youngs_modulus, double poissons_ratio, double edge);

/// Springs of one stiffness inside the body: edges, face and internal diagonals alike.
/// @param stiffness  of every spring, N/mm
CellStiffness uniform_springs(double stiffness);

/// The stiffness, N/mm, with which a large lattice of such springs has Young's modulus E along its axes:
/// C11 = 13 k/(3 a) and C12 = 7 k/(3 a) make it E = 2.7 k/a.
double uniform_stiffness(double youngs_modulus, double edge);

} // namespace springproof::msm
