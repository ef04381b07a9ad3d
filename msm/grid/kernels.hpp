#pragma once

#include "mechanics/grid/instruction_set.hpp"
#include "mechanics/grid/layout.hpp"
#include "mechanics/grid/masses.hpp"
#include "msm/spring_laws.hpp"

#include <cstddef>
#include <cstdint>

/// Force, energy, tangent product and tangent diagonal of a lattice on a grid, straight from displacements.
/// The kernels see plain arrays only, so that one source can be compiled for several instruction sets; which
/// one runs is decided when the program starts.
namespace springproof::msm::grid {

/// Half of a node's 26 neighbours, as steps (dx, dy, dz) in the grid: groups of three springs lead to dx =
/// -1, 0, 1 in one neighbouring row, and the last one to the next node of the same row.
constexpr int n_springs = 13;
constexpr int spring_steps[n_springs][3] = {{-1, -1, 1}, {0, -1, 1}, {1, -1, 1}, {-1, 0, 1}, {0, 0, 1},
                                            {1, 0, 1},   {-1, 1, 1}, {0, 1, 1},  {1, 1, 1},  {-1, 1, 0},
                                            {0, 1, 0},   {1, 1, 0},  {1, 0, 0}};

using mechanics::grid::Layout;

/// A lattice on a grid. Lengths in mm, stiffnesses in N/mm; Real is float inside the preconditioner.
template<class Real>
struct Springs {
  Layout layout;
  Real rest[n_springs][3];     ///< vector from a node to its neighbour at rest
  Real rest_length[n_springs]; ///< its length
  Real stiffness[n_springs];   ///< one cell's spring's; 1 where `by_node` gives the stiffness
  LawKind law;
  Real parameter[n_springs]; ///< the law's
  /// Without holes: number of cells that share a spring is share[dy + 1][dx + 1] of its node's place in the
  /// plane times share_z[k][dz + 1]. Arrays of layout.plane from the first node of a plane on, 0 for ghosts.
  const Real* share;
  const Real* share_z;
  /// Such arrays [k][spring], with holes or several stiffnesses; else null.
  const Real* by_node;
  /// The same as the springs are swept: blocks of the 13 springs of a pack of nodes, those that differ; null
  /// where by_node is.
  const Real* packed;
  const int* block_of_pack; ///< each pack's block in `packed`, row by row; null where by_node is
  /// PackUse of every pack of nodes, row by row, as pack_stiffness() finds it; null where by_node is.
  const unsigned char* pack_use;
  /// Cell volume term: k_v/V0 (MPa/mm³) of the cell whose lowest vertex the node is, or null.
  const Real* volume_stiffness;
  Real rest_volume; ///< mm³
  /// Stiffness along x, y, z of the springs between the centres of that cell's opposite faces, or null;
  /// with them there are volume terms, if of stiffness 0. Law and rest length are those of its edges.
  const Real* midline[3];
  /// 1 for nodes whose springs and cells (those that lead upwards from them) count in the energy, else 0: an
  /// array of layout.plane from the first node of any plane on.
  const Real* counted;
};

/// Whether a sweep has to touch a pack of nodes: much of a body's bounding box may be empty.
enum PackUse : unsigned char {
  sends_springs = 1, ///< some spring from it to another node has a stiffness
  meets_springs = 2  ///< it, or a node next to it in its row, is an end of such a spring
};

using msm::Clamp;

/// Part of an array that one call works on: planes first to last - 1. Contributions to plane `last` go to
/// `spill` (as many planes as the result has arrays), because that plane belongs to another part; spill and
/// the planes themselves are set, not added to, but for nodes that meet no spring, which stay 0 as in every
/// field.
template<class Real>
struct Slab {
  int first, last;
  Real* spill;
  Real* scratch; ///< scratch_size(layout) entries
};

/// Packs of a row that the springs are swept in at a time: with three, what the five rows that a row's
/// springs meet need fits into a first-level cache of 48 kB (timed against 2, 4, 6 and 8).
constexpr std::ptrdiff_t tile = 3;

constexpr std::ptrdiff_t scratch_size(const Layout& layout) {
  const std::ptrdiff_t tile_row = tile * 16;
  return tile_row * (2 * 27 * (layout.nodes[1] + 2) + 3 * n_springs) + 24 * 64 + 16;
}

/// How the packs of a row are shared out among tiles: tile t begins at pack first_of_tile(n_packs, t).
constexpr std::ptrdiff_t tiles_of_row(std::ptrdiff_t n_packs) {
  return (n_packs + tile - 1) / tile;
}
constexpr std::ptrdiff_t first_of_tile(std::ptrdiff_t n_packs, std::ptrdiff_t t) {
  return n_packs * t / tiles_of_row(n_packs);
}

/// Entries of Springs::pack_use, with any instruction set.
constexpr std::ptrdiff_t pack_use_size(const Layout& layout) {
  return std::ptrdiff_t{layout.nodes[2]} * layout.nodes[1] * layout.nodes[0];
}

/// Entries that pack_stiffness() fills, with any instruction set.
constexpr std::ptrdiff_t packed_size(const Layout& layout) {
  return std::ptrdiff_t{layout.nodes[2]} * layout.nodes[1] * ((layout.nodes[0] + 15) / 16 * 16) * n_springs;
}

/// Numbers that a clamped tangent is kept in, so that its products need no law: for every pack of a row's
/// nodes each spring's transverse and along (SpringTangent), a pack of each, row by row; and from
/// kept_cells() on, for every plane, arrays of its cells: the volume term's slope, and both numbers of the
/// midlines.
constexpr std::ptrdiff_t kept_cells(const Layout& layout) {
  return 2 * packed_size(layout);
}
constexpr int kept_per_cell = 7;
/// Entries of a plane's arrays of cells: the rows that have cells above them, in whole packs.
constexpr std::ptrdiff_t cells_of_plane(const Layout& layout) {
  return (layout.row * (layout.nodes[1] - 1) + 15) / 16 * 16;
}
constexpr std::ptrdiff_t kept_size(const Layout& layout, bool has_cells) {
  return kept_cells(layout) + (has_cells ? kept_per_cell * layout.nodes[2] * cells_of_plane(layout) : 0);
}

template<class Real>
struct Kernels {
  /// force = minus the gradient of the energy.
  void (*force)(const Springs<Real>&, const Slab<Real>&, const Real* displacement, Real* force);
  /// product = tangent at displacement times direction.
  void (*product)(const Springs<Real>&, const Slab<Real>&, Clamp, const Real* displacement,
                  const Real* direction, Real* product);
  /// product = a kept tangent times direction; it was kept at the displacement.
  void (*kept_product)(const Springs<Real>&, const Slab<Real>&, const Real* kept, const Real* displacement,
                       const Real* direction, Real* product);
  /// Diagonal 3x3 blocks of the tangent as six arrays: xx, yy, zz, yz, xz, xy. spill has six planes.
  /// @param kept  kept_size() entries, which get the tangent; null: it is not kept
  void (*diagonal)(const Springs<Real>&, const Slab<Real>&, Clamp, const Real* displacement, Real* diagonal,
                   Real* kept);
  double (*energy)(const Springs<Real>&, int first, int last, const Real* displacement);
  /// Orders the stiffnesses by_node as springs are swept: a block of 13 for every pack, row by row.
  void (*pack_stiffness)(const Springs<Real>&, Real* to, unsigned char* use);
  /// Adds the masses' product with a field to the planes k and k + 1 of nodes.
  void (*mass)(const Layout&, const mechanics::grid::Masses<Real>&, const Real* field, Real* product,
               int layer);
  int pack; ///< numbers computed at once
};

/// Rows of a factor's block that lie together, column after column; the last may be 16.
constexpr int panel_rows = 32;

/// Rounds up to whole packs, so that none has to be cut off.
constexpr int padded(int n) {
  return (n + 15) / 16 * 16;
}

/// Columns of a factor that have the same rows below them: D their diagonal block, B the rows below. Kept are
/// the inverse of D and, below it, B times that inverse, each column in steps of its own: 16 bits take half
/// the time to read that single precision does, and reading is what a substitution takes its time for.
struct FactorBlock {
  int first;       ///< first of its unknowns, which follow each other
  int n_columns;   ///< number of its unknowns
  int n_below;     ///< unknowns after them that they are coupled with ...
  const int* rows; ///< ... and which
  /// Panels of padded(n_columns + n_below) rows in all. Rows below are divided by `below`, which brings them
  /// to the size of the inverse.
  const std::int16_t* values;
  const float* steps; ///< one per column; 15 numbers more are read
  float below;
  /// Numbers from one block to the next: whole lines of the cache.
  std::ptrdiff_t n_values() const {
    return (std::ptrdiff_t{n_columns} * padded(n_columns + n_below) + panel_rows - 1) / panel_rows *
           panel_rows;
  }
  int n_scratch() const { return padded(n_columns + n_below) + 16 * n_columns + 16; }
};

/// A factor L of a symmetric matrix L L^T, by blocks.
struct BlockFactor {
  const FactorBlock* blocks;
  int n_blocks;
};

/// The kernels compiled for one instruction set.
struct KernelSet {
  Kernels<double> in_double;
  Kernels<float> in_float;
  /// x = (L L^T)^-1 x.
  /// @param x        15 numbers more than unknowns, which are read
  /// @param scratch  the most n_scratch() of any block
  void (*substitute)(const BlockFactor&, float* x, float* scratch);
};
SPRINGPROOF_KERNEL_SETS(KernelSet, kernel_set)

template<class Real>
const Kernels<Real>& kernels() {
  if constexpr (sizeof(Real) == sizeof(double))
    return kernel_set().in_double;
  else
    return kernel_set().in_float;
}

} // namespace springproof::msm::grid
