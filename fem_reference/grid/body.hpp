#pragma once

#include "fem_reference/grid/field.hpp"

#include <array>
#include <functional>
#include <vector>

namespace springproof::fem_reference::grid {

/// A body made of equal cuboids, as the kernels see it: the cells and nodes of a slab.
struct Body {
  /// @param cells  of the whole grid    @param slab  of its planes of nodes
  Body(const std::array<int, 3>& cells, const Slab& slab, const Eigen::Vector3d& spacing, Law law,
       bool has_modes);

  std::array<int, 3> cells; ///< of the slab
  Eigen::Vector3d spacing;  ///< mm
  Layout layout;
  Slab slab;
  Law law;
  bool has_modes;                 ///< a pressure of its own in every cell
  std::vector<float> weight;      ///< per cell entry of the layout: 1, or 0 where there is none
  int n_parameters = 0;           ///< of the law
  std::vector<double> parameters; ///< n_parameters for all cells, or [parameter][cell entry]
  Field<float> free;              ///< 0 where constrained or without a cell, else 1

  bool has_one_material() const { return parameters.size() == static_cast<std::size_t>(n_parameters); }
  std::array<int, 3> cells_of_grid() const { return {cells[0], cells[1], slab.n_planes_of_grid() - 1}; }
  Space space(int n_threads) const { return {layout, slab, n_threads}; }
  /// For the kernels; points into this body.
  Cells view() const;
};

Layout make_layout(const std::array<int, 3>& cells);

/// Whether node (i, j, k) touches a cell that is held.
bool has_cell(const Body& body, int i, int j, int k);

/// A rank's slab of a grid; the whole grid on every rank when it is small.
/// @param multiple  of which each rank's first plane is one
Slab deal(const std::array<int, 3>& cells, MPI_Comm communicator, int multiple);

/// The slab of the grid that is coarser along some axes: gathered when it is small or the ranks run out of
/// planes.
Slab coarsen(const Slab& fine, const std::array<int, 3>& cells_of_coarse_grid, bool along_z);

/// The axes along which a grid is next coarsened: those whose spacing is (almost) the smallest, so that cells
/// tend to cubes. None: it is as coarse as it gets.
std::array<bool, 3> axes_to_coarsen(const std::array<int, 3>& cells, const Eigen::Vector3d& spacing);

/// The same body in cells of twice the edge along some axes: a coarse cell has the mean weight and parameters
/// of its fine ones; a node is constrained where the fine node at its place is.
Body coarsen(const Body& fine, const std::array<bool, 3>& axes);

} // namespace springproof::fem_reference::grid
