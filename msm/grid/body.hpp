#pragma once

#include "msm/grid/kernels.hpp"

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace springproof::msm::grid {

/// Calls action(i, j, k) for all of n[0] * n[1] * n[2] cells or nodes, x fastest.
template<class Counts, class Action>
void for_each_place(const Counts& n, const Action& action) {
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) action(i, j, k);
}

/// The springs of one cell of a grid. A coarser cell need not be a cube: its edges differ, and its face
/// diagonals.
struct CellSprings {
  std::array<double, 3> edge{};          ///< along x, y, z, N/mm
  std::array<double, 3> face_diagonal{}; ///< in the planes yz, xz, xy, N/mm
  double internal_diagonal = 0;          ///< N/mm
  double volume = 0;                     ///< k_v, MPa
  bool is_empty() const;
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

/// Fills in layout and constrained.
void set_layout(Body& body, const std::function<bool(int i, int j, int k, int component)>& is_constrained);

/// Whether a node touches a cell.
bool has_cell(const Body& body, int i, int j, int k);

/// The same body in cells of twice the edge along those axes whose spacing is (almost) the smallest, so that
/// cells tend to cubes; nothing when it is as coarse as it gets. A coarse spring has the energy of the fine
/// ones in the same uniform strain; cells that are half outside have half the stiffness. A node is held where
/// the fine node at its place is.
std::optional<Body> coarsen(const Body& fine);

} // namespace springproof::msm::grid
