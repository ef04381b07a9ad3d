#pragma once

#include "msm/spring_body.hpp"

/// Springs that others published. Those of cubical cells belong to the family of k_e, k_f, k_d and k_v, where
/// an interior edge has 4 k_e, an interior face diagonal 2 k_f. @param edge  the cell's edge, mm, > 0
///
/// Other cells are cut into five tetrahedra: one at each of four corners, one between them. The cut is
/// mirrored from cell to cell, so that neighbours agree on the diagonal of their common face: cell (i, j, k)
/// has the kind (i + j + k) % 2. Every cell keeps 12 edges and 6 of its 12 face diagonals.
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
/// @param stiffness  stiffness of every spring, N/mm
CellStiffness uniform_springs(double stiffness);

/// The stiffness, N/mm, with which a large lattice of such springs has Young's modulus E along its axes:
/// C11 = 13 k/(3 a) and C12 = 7 k/(3 a) make it E = 2.7 k/a.
double uniform_stiffness(double youngs_modulus, double edge);

/// The tetrahedra of a cell by their vertices, the central one last, all of positive volume in a cell that is
/// not inverted.  @param kind  0: the central one has vertex 0; 1: its mirror image
std::array<std::array<int, 4>, 5> five_tetrahedra(int kind);

/// Every edge of a tetrahedron of volume V and edge length l adds E V/l².
/// @param vertices  vertices of the cell, mm    @param youngs_modulus  MPa    @return both kinds
/// Source: Van Gelder 1998, "Approximate simulation of elastic membranes by triangulated spring meshes", in
/// three dimensions.
std::vector<CellTerms> van_gelder(const CellPositions& vertices, double youngs_modulus);

/// Every edge of a tetrahedron of volume V adds 2 sqrt(2)/25 E L, L = (12 V/sqrt(2))^(1/3) the edge of the
/// regular tetrahedron of that volume.
/// Source: Lloyd, Székely & Harders 2007, "Identification of spring parameters for deformable object
/// simulation".
std::vector<CellTerms> lloyd(const CellPositions& vertices, double youngs_modulus);

/// The tetrahedra with biquadratic springs (tetrahedron.hpp): linear finite elements of the St.
/// Venant-Kirchhoff material.  @param lambda, mu  MPa    Source: Delingette 2008.
std::vector<CellTerms> biquadratic(double lambda, double mu);

} // namespace springproof::msm
