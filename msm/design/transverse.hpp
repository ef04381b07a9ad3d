#pragma once

#include "mechanics/elastic_moduli.hpp"

#include <array>

/// Springs of cubical cells for a transversely isotropic material whose fibre lies along an axis of the grid.
namespace springproof::msm {

/// The moduli that a lattice can have, C12 - C66 = C13 - C44, nearest to the material's.
struct NearestModuli {
  mechanics::TransverseModuli moduli; ///< MPa; c66 is (c11 - c12)/2 only if the material has the relation
  double distance; ///< || C^-1/2 (C_lattice - C) C^-1/2 ||_F: of the energies of the strains, relative
  double misfit;   ///< largest relative error of the energy of any strain
};

/// Least distance, in closed form: 0 for a material with the relation. The relative norm keeps Young's moduli
/// of a material that hardly changes its volume, where the plain one would give them away for the bulk
/// modulus.
NearestModuli nearest_lattice_moduli(const mechanics::TransverseModuli& material);

/// Stiffnesses of one cell by axis.
struct AxisStiffness {
  std::array<double, 7> springs; ///< N/mm: k_e along x, y, z; k_f in the faces across x, y, z; k_d
  double volume;                 ///< k_v, MPa
};

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

} // namespace springproof::msm
