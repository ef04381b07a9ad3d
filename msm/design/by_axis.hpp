#pragma once

#include "msm/design/lattice_moduli.hpp"
#include "msm/design/transverse.hpp"
#include "msm/spring_body.hpp"

#include <optional>

/// Springs that differ from axis to axis, for cells that are no cubes: one stiffness for all edges cannot
/// follow a material in a box.
namespace springproof::msm {

/// What the lattice shall have: C_ii = c11 + volume, C_ij = c44 + volume and the shear moduli c44, MPa.
struct CubicModuli {
  double c11, c44;
  double volume; ///< k_v
};

/// Springs of a box of edges l_i and volume V, whose lattice has the moduli exactly. Per cell, with D = 4
/// k_d/(L² V), L the internal diagonal, and F_ij = 4 k_f l_i² l_j²/(l² V) of the face diagonals of length l,
///   F_ij = c44 - D l_i² l_j²,  4 k_e l_i²/V = c11 - sum over j of F_ij l_i²/l_j² - D l_i⁴ :
/// one number is free, the part t of c44 that the internal diagonals carry where they carry most, D l_i² l_j²
/// = t c44 in the largest face. The least t from `split` on with which every kind has stiffness enough.
/// @return nothing for a hexahedron that is no box, and where no t has: with an isotropic target from edges
/// on that differ by a factor of 1.67
/// @param split  t, 0 to 1
std::optional<AxisStiffness> exact_by_axis(const CubicModuli& moduli, double split,
                                           const CellVertices& vertices);

/// Springs of any hexahedron, none of stiffness 0, whose energies of uniform strains are nearest to the
/// target's: the least || C^-1/2 (C_cell - C) C^-1/2 ||_F² + w² (t_cell - t)², the weight w of 0.01 for what
/// those energies do not tell.
AxisStiffness nearest_by_axis(const CubicModuli& moduli, double split, const CellVertices& vertices);

/// Nothing for a cube, where four stiffnesses have the moduli. In a box the exact springs, or else the
/// nearest; in another hexahedron the nearest where the four miss a modulus by more than told_moduli_misfit.
std::optional<AxisStiffness> by_axis_where_needed(const CellStiffness& four, const CubicModuli& moduli,
                                                  double split, const CellVertices& vertices);

Elasticity elasticity_of(const CubicModuli& moduli);

/// Whether a cell is a box along the axes, to 1e-9 of its edges.
bool is_box(const CellVertices& vertices);

} // namespace springproof::msm
