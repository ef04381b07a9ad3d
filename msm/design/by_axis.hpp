#pragma once

#include "mechanics/elastic_moduli.hpp"
#include "msm/design/cells.hpp"

/// Springs that differ from axis to axis: for a transversely isotropic material whose fibre lies along an
/// axis of the grid, and for cells that are no cubes, where one stiffness for all edges cannot follow a
/// material.
namespace springproof::msm {

/// The moduli that a lattice can have, C12 - C66 = C13 - C44, nearest to the material's.
struct NearestModuli {
  mechanics::TransverseModuli moduli; ///< MPa; c66 is (c11 - c12)/2 only if the material has the relation
  double distance; ///< || C^-1/2 (C_lattice - C) C^-1/2 ||_F: of the energies of the strains, relative
  double misfit;   ///< largest relative error of the energy of any strain
};

/// Finds the nearest moduli in closed form; their distance is 0 for a material with the relation. The
/// relative norm keeps a nearly incompressible material's Young's moduli, which the plain one would give away
/// for the bulk modulus.
NearestModuli nearest_lattice_moduli(const mechanics::TransverseModuli& material);

/// The springs of a lattice of these moduli. Along the fibre (3) and across it (1, 2), with totals between
/// two nodes of K_e = 4 k_e, K_f = 2 k_f (K_f3 in the faces across the fibre, K_f1 in those along it), K_d =
/// k_d and s = 4 K_d/(3 h),
///   C11 = (K_e1 + K_f1 + K_f3)/h + s + k_v,  C33 = (K_e3 + 2 K_f1)/h + s + k_v,
///   C12 = K_f3/h + s + k_v,  C66 = K_f3/h + s,  C13 = K_f1/h + s + k_v,  C44 = K_f1/h + s;
/// the internal diagonals get the part `split` of the smaller shear modulus, s = t min(C44, C66).
/// @param moduli  with C12 - C66 = C13 - C44     @param split  t, 0 to 1    @param fibre  axis 0, 1, 2
/// @param edge  h, mm
AxisStiffness stiffness_by_axis(const mechanics::TransverseModuli& moduli, double split, int fibre,
                                double edge);

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

} // namespace springproof::msm
