#pragma once

#include "msm/design/cells.hpp"

/// Springs between the centres of a cell's opposite faces, the midlines, which take over a part of the edges'
/// stiffness: four edges of equal elongation and a midline of the same elongation are one spring, so that
/// moduli and curves stay what they are, whereas a midline does not resist the cell's bending, which edges
/// alone resist too much. Derived in docs/developing/midlines.md.
namespace springproof::msm {

/// The part r of the edges' stiffness that stays with them in a cube, beta times the one with which a
/// slender bar of one cell across bends as its material does:
///   r = beta [m - f + sqrt(m² + f²)]/(1 + t),  m = (1 + nu)/3,  f = 1 - t.
/// At most 1, where nothing is left for midlines.
/// @param split  t, 0 to 1, of hybrid_method()
double edge_part(double poissons_ratio, double split, double beta);

/// beta of a cell where the body is n cells thick: 1 at one cell, where the bar's exact bending decides, and
/// 0.8 from many on, without a step. What cells resist of a section's bending falls as 1/n², and so does the
/// weight of the first value. The 0.8 is chosen, on bodies with clamped ends, which meshes make too stiff.
double default_beta(int cells_across);

/// The same moduli with a part of the edges' stiffness that stays and 4 (1 - r) k_e for each midline.
CellStiffness with_midlines(CellStiffness stiffness, double edge_part);

/// The same for a cell whose springs differ by axis, or that is no cube: r by axis, from 0.05 to 1, of
/// least sum of squares of the logarithms of E I of six slender bars, one cell across, along each axis and
/// bent towards each other one, over their exact ones; then times beta. Exact in a cube.
/// @param vertices  a box along the axes, or a hexahedron near one, mm
void add_midlines(CellTerms& terms, const CellVertices& vertices, double beta);

/// E I of a slender bar, one cell across, bent by end moments, over the exact one of a material that has the
/// cell's moduli.
/// @param fibre, gradient  axes: along the bar, and the one along which the strain grows
double bending_stiffness(const CellTerms& terms, const CellVertices& vertices, int fibre, int gradient);

} // namespace springproof::msm
