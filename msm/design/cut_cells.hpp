#pragma once

#include "msm/spring_body.hpp"

/// Cells cut into five tetrahedra: one at each of four corners, and one between them. In a grid the cut is
/// mirrored from cell to cell, so that neighbours agree on the diagonal of their common face: cell (i, j, k)
/// has the kind (i + j + k) % 2. Every cell keeps 12 edges and 6 of its 12 face diagonals.
namespace springproof::msm {

/// The tetrahedra of a cell by their vertices, the central one last, all of positive volume in a cell that is
/// not inverted.  @param kind  0: the central one has vertex 0; 1: its mirror image
std::array<std::array<int, 4>, 5> five_tetrahedra(int kind);

/// Every edge of a tetrahedron of volume V and edge length l adds E V/l².
/// @param vertices  of the cell, mm    @param youngs_modulus  MPa    @return both kinds
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
