#pragma once

#include "msm/design/cells.hpp"

/// Designs from a material at small strains: the linear method, the moduli method and the hybrid method, and
/// those that others published.
namespace springproof::msm {

/// Small-strain E and nu of a material: a hyperelastic one has its moduli at rest, and nu = 0.5 without
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

/// C11 of the springs of moduli_method(), MPa.
double c11_of_springs(double youngs_modulus, double shear_modulus);

/// Springs and a cell volume term nearest to the isotropic elasticity with the given Lamé constants, which
/// they meet in a cube: C11 = 3 mu and C12 = C44 = mu of the springs, so that K_e = K_f + 8 K_d/3, and k_v =
/// lambda - mu, which is negative below nu = 1/4, where lambda < mu.
/// @param lame_lambda, lame_mu  MPa, lame_mu > 0    @param split, vertices  as for moduli_method()
CellStiffness hybrid_method(double lame_lambda, double lame_mu, double split, const CellVertices& vertices);

/// Springs that others published. Those of cubical cells belong to the family of k_e, k_f, k_d and k_v, where
/// an interior edge has 4 k_e, an interior face diagonal 2 k_f. @param edge  the cell's edge, mm, > 0
///
/// Other cells are cut into five tetrahedra: one at each of four corners, one between them. The cut is
/// mirrored from cell to cell, so that neighbours agree on the diagonal of their common face: cell (i, j, k)
/// has the kind (i + j + k) % 2. Every cell keeps 12 edges and 6 of its 12 face diagonals.

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

/// The tetrahedra with biquadratic springs (Tetrahedron): linear finite elements of the St.
/// Venant-Kirchhoff material.  @param lambda, mu  MPa    Source: Delingette 2008.
std::vector<CellTerms> biquadratic(double lambda, double mu);

/// The same springs of a mesh's own tetrahedron.
/// @param design  van_gelder, lloyd or biquadratic
CellTerms in_tetrahedron(cases::Design design, const TetrahedronPositions& x,
                         const cases::LinearElastic& material);

} // namespace springproof::msm
