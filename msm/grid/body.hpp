#pragma once

#include "msm/grid/kernels.hpp"
#include "msm/lattice.hpp"

#include <array>
#include <vector>

namespace springproof::msm::grid {

/// The springs of one cell of a grid. A coarser cell need not be a cube: its edges differ, and its face
/// diagonals.
struct CellSprings {
  std::array<double, 3> edge{};          ///< along x, y, z, N/mm
  std::array<double, 3> face_diagonal{}; ///< in the planes yz, xz, xy, N/mm
  double internal_diagonal = 0;          ///< N/mm
  double volume = 0;                     ///< k_v, MPa
};

/// A body made of the cells of a grid, and what holds it.
struct Body {
  std::array<int, 3> cells;
  Eigen::Vector3d spacing;          ///< mm
  std::vector<CellSprings> springs; ///< of every cell, x fastest, all 0 where there is none; or one for all
  Layout layout;
  std::vector<std::ptrdiff_t> constrained; ///< entries of a field that never change: constrained dofs, and
                                           ///< entries without a cell. Sorted.

  bool is_uniform() const { return springs.size() == 1; }
  const CellSprings& cell(int i, int j, int k) const;
};

Layout make_layout(const std::array<int, 3>& cells);

/// Fills in layout and constrained.  @param is_constrained  (node i, j, k, component)
template<class IsConstrained>
void set_layout(Body& body, const IsConstrained& is_constrained);

/// Whether a node touches a cell.
bool has_cell(const Body& body, int i, int j, int k);

/// The axes along which a body is next coarsened: those whose spacing is (almost) the smallest, so that cells
/// tend to cubes. None: it is as coarse as it gets.
std::array<bool, 3> axes_to_coarsen(const Body& body);

/// The same body in cells of twice the edge along some axes. A coarse spring has the energy of the fine ones
/// in the same uniform strain; cells that are half outside have half the stiffness. A node is held where the
/// fine node at its place is.
Body coarsen(const Body& fine, const std::array<bool, 3>& axes);

// ---- implementation ----

template<class IsConstrained>
void set_layout(Body& body, const IsConstrained& is_constrained) {
  body.layout = make_layout(body.cells);
  body.constrained.clear();
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k <= body.cells[2]; ++k)
      for (int j = 0; j <= body.cells[1]; ++j)
        for (int i = 0; i <= body.cells[0]; ++i)
          if (is_constrained(i, j, k, c) || !has_cell(body, i, j, k))
            body.constrained.push_back(c * body.layout.size + body.layout.at(i, j, k));
}

} // namespace springproof::msm::grid
