#pragma once

#include "fem_reference/grid/laws.hpp"
#include "mechanics/grid/instruction_set.hpp"
#include "mechanics/grid/layout.hpp"
#include "mechanics/grid/masses.hpp"

#include <cstddef>

/// Internal forces, tangents and products of trilinear elements on a grid of equal cuboids, several cells at
/// a time. The kernels see plain arrays only, so that one source can be compiled for several instruction
/// sets; which one runs is decided when the program starts.
namespace springproof::fem_reference::grid {

using mechanics::grid::Layout;
using mechanics::grid::Masses;

/// A matrix of 3x3 blocks between each node and its 27 neighbours: for every row of nodes (j, k) the entries
/// [(9*neighbour + 3*c + d)][i], neighbour = (dx+1) + 3(dy+1) + 9(dz+1). Rows begin stencil_row(layout)
/// apart.
constexpr int n_stencil = 27 * 9;
inline std::ptrdiff_t stencil_row(const Layout& layout) {
  return n_stencil * layout.row + 16;
}

/// Cell matrices: the upper triangle of 24x24, row 3*corner + component. Every row of cells (j, k) has the
/// entries [upper(r, s)][i].
constexpr int n_upper = 300;
constexpr int upper(int r, int s) {
  return r <= s ? 24 * r - r * (r - 1) / 2 + s - r : 24 * s - s * (s - 1) / 2 + r - s;
}

/// Unknowns of its own that a cell has, beside the displacements of its nodes.
enum class Internal {
  none,
  pressure, ///< a constant one
  bubbles   ///< Wilson's: 4 t (1 - t) for t = 0 to 1 along each axis, with three components each
};
constexpr int n_fields(Internal internal) {
  return internal == Internal::none ? 0 : internal == Internal::pressure ? 1 : 9;
}

/// What the kernels know of a body.
struct Cells {
  Layout layout;
  Law law;
  Internal internal;
  double gradients[8][8][3];     ///< dN_a/dX at Gauss point q: [q][a], 1/mm
  double bubbles[8][3];          ///< slopes along their axes at Gauss point q: [q][bubble], 1/mm
  double point_volume;           ///< one Gauss point's, mm³
  const float* weight;           ///< per cell: 1, 0 where there is none, between on coarser grids
  int n_parameters;              ///< as parameters_of() of mechanics has them
  const double* parameters;      ///< the same for all cells; or null
  const double* cell_parameters; ///< [parameter][cell]
};

/// Triquadratic elements; without pressures of their own.
struct Quadratic {
  Cells cells;                 ///< the elements; their layout's cells, weights and parameters are used
  Layout nodes;                ///< the grid of their nodes, with cells of half the edge
  double gradients[27][27][3]; ///< dN_a/dX at Gauss point q: [q][a], 1/mm
  double weights[27];          ///< the Gauss points', mm³
};

/// Results of a layer of cells.
struct Checks {
  bool valid = true;           ///< false: J <= 0 or not a number at a Gauss point of some cell
  double volume_mismatch = 0;  ///< the largest that a cell's pressure leaves, relative
  double bubble_imbalance = 0; ///< sum of the squared forces on bubbles, N²
};

struct ForceFields {
  const double* displacement;
  const double* internal; ///< the cells' unknowns: [field][cell], MPa or mm
  double* force;          ///< added to: internal force, N
  double* condensed;      ///< added to: the same with the imbalance of the cells' unknowns; or null
  double* volume;         ///< per cell: deformed volume, mm³; or null
};

struct TangentFields {
  const double* displacement;
  const double* internal;
  const float* free; ///< field: 0 where constrained, else 1; null when there is no coarser level
  float* stencil;    ///< added to
  float* coarse;     ///< added to: cell matrices of the coarser grid; or null
  const Masses<double>* masses = nullptr; ///< added to the cells' matrices, t/s²; or null
};

/// A grid in cells twice as large along some axes.
struct Coarsening {
  Layout layout; ///< the coarser grid's
  bool axes[3];
  int first, first_coarse; ///< layers of the two grids before those of the layouts
};

struct Kernels {
  /// Layer k of cells: adds to the planes k and k + 1 of nodes.
  void (*force)(const Cells&, const ForceFields&, int layer, Checks&);
  /// Change of the cells' unknowns with a step, to first order: C^-1 (R + B step) of pressures,
  /// -K_bb^-1 (f_b + K_bu step) of bubbles. The state is `fields`'.
  void (*internal_change)(const Cells&, const ForceFields& fields, const double* step, double* change,
                          int layer);
  /// The tangent; its symmetric part for the coarser grid.
  void (*tangent)(const Cells&, const TangentFields&, const Coarsening&, int layer);
  /// Matrix of a coarser grid from its cell matrices, and cell matrices of the next one.
  void (*deposit)(const Layout&, const float* cells, float* stencil, float* coarse, const Coarsening&,
                  int layer);
  /// product = stencil * field in plane k of nodes, times free where that is given.
  void (*product)(const Layout&, const float* stencil, const double* field, const float* free,
                  double* product, int plane);
  void (*product_float)(const Layout&, const float* stencil, const float* field, const float* free,
                        float* product, int plane);
  /// As force, for the planes 2 k to 2 k + 2 of nodes.
  void (*quadratic_force)(const Quadratic&, const ForceFields&, int layer, Checks&);
  /// Weighted moduli of every row of cells: [point][entry of dP/dF][i].
  void (*quadratic_moduli)(const Quadratic&, const double* displacement, float* moduli, int layer);
  /// Adds the tangent's product with a field.
  void (*quadratic_product)(const Quadratic&, const float* moduli, const double* field, double* product,
                            int layer);
  /// Adds the masses' product with a field to the planes k and k + 1 of nodes.
  void (*mass)(const Layout&, const Masses<double>&, const double* field, double* product, int layer);
};

SPRINGPROOF_KERNEL_SETS(Kernels, kernels)

} // namespace springproof::fem_reference::grid
