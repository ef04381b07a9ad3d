#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/grid/slab.hpp"

#include <array>
#include <functional>
#include <vector>

namespace springproof::fem_reference::grid {

/// A body made of equal cuboids, as the kernels see it: the cells and nodes of a slab.
struct Body {
  /// @param cells  the whole grid's    @param slab  the planes of nodes that this rank holds
  Body(const std::array<int, 3>& cells, const Slab& slab, const Eigen::Vector3d& spacing, Law law,
       Internal internal);

  std::array<int, 3> cells; ///< the slab's
  Eigen::Vector3d spacing;  ///< mm
  Layout layout;
  Slab slab;
  Law law;
  Internal internal;
  std::vector<float> weight;      ///< per cell entry of the layout: 1, or 0 where there is none
  int n_parameters = 0;           ///< the law's
  std::vector<double> parameters; ///< n_parameters for all cells, or [parameter][cell entry]
  Field<float> free;              ///< 0 where constrained or without a cell, else 1

  bool has_one_material() const { return parameters.size() == static_cast<std::size_t>(n_parameters); }
  std::array<int, 3> cells_of_grid() const { return {cells[0], cells[1], slab.n_planes_of_grid() - 1}; }
  /// Entries of the cells' own unknowns in a state: [field][cell entry], and what packs read beyond.
  std::ptrdiff_t n_internal() const {
    return internal == Internal::none ? 0 : n_fields(internal) * layout.n_cell_entries() + 16;
  }
  Space space(int n_threads) const { return {layout, slab, n_threads}; }
  /// Returns what the kernels need; it points into this body.
  Cells view() const;
};

/// Rows are padded to whole packs; a plane and a row of ghosts lie before the first node and after the last.
/// Ghosts are numbers, and 0 in what is summed over.
Layout make_layout(const std::array<int, 3>& cells);

/// Whether node (i, j, k) touches a cell that is held.
bool has_cell(const Body& body, int i, int j, int k);

using Place = Eigen::Vector3i; ///< a node's indices in its grid

/// Where the nodes of a grid are, and which of them a rank has.
struct Places {
  Eigen::Vector3d origin, spacing; ///< mm
  const Body& body;

  Place of(const Eigen::Vector3d& rest) const {
    const Eigen::Vector3d at = (rest - origin).cwiseQuotient(spacing);
    return at.array().round().cast<int>();
  }
  Eigen::Vector3d rest(const Place& at) const { return origin + at.cast<double>().cwiseProduct(spacing); }
  bool holds(const Place& at) const { return is_in({0, body.slab.n_planes()}, at); }
  bool owns(const Place& at) const { return is_in(body.slab.computed(), at); }
  /// Entry of a node that is held, in the body's layout.
  std::ptrdiff_t entry(const Place& at) const {
    return body.layout.at(at.x(), at.y(), at.z() - body.slab.first_of_grid());
  }
  /// Calls action(place) for the nodes of the elements that the rank computes.
  template<class Action>
  void for_each(const Action& action) const {
    const auto [begin, end] = body.slab.computed();
    for (int k = begin; k < end; ++k)
      for (int j = 0; j <= body.cells[1]; ++j)
        for (int i = 0; i <= body.cells[0]; ++i)
          if (has_cell(body, i, j, k)) action(Place(i, j, body.slab.first_of_grid() + k));
  }

 private:
  bool is_in(const Slab::Range& planes, const Place& at) const {
    const int plane = at.z() - body.slab.first_of_grid();
    return plane >= planes.begin && plane < planes.end;
  }
};

/// A rank's slab of a grid; the whole grid on every rank when it is small.
/// @param multiple  each rank's first plane is a multiple of it
Slab deal(const std::array<int, 3>& cells, MPI_Comm communicator, int multiple);

/// The slab of the grid that is coarser along some axes: gathered when it is small or the ranks run out of
/// planes.
Slab coarsen(const Slab& fine, const std::array<int, 3>& cells_of_coarse_grid, bool along_z);

/// The same body in cells that are `factor` fine ones along each axis: a coarse cell has the mean weight and
/// parameters of its fine ones; a node is constrained where the fine node at its place is.
Body coarsen(const Body& fine, const std::array<int, 3>& factor);

/// Loads and supports of a body.
struct Supported {
  Field<double> load;                ///< N at full load; 0 on constrained entries
  std::vector<std::ptrdiff_t> moved; ///< entries of a field whose displacement is prescribed and not 0
  /// Their displacement (mm) at a load factor; empty when no rank has any. Collective.
  std::function<std::vector<double>(double load_factor)> prescribed;
  std::function<std::vector<double>(double time)> prescribed_at; ///< the same in a motion; s
};

/// The loads and motions of a scene on a rank's part of a grid.
/// @param scene         the scene on the elements' mesh
/// @param is_quadratic  elements have nodes on their edges and faces too: places are halves of them
/// @param body          the body of `places`; its `free` is set
Supported make_supported(const cases::Scene& scene, bool is_quadratic, const Places& places, Body& body);

/// Loads of a scene, N at full load; 0 on constrained entries.
/// @param scene, places  as in make_supported(), after which it may be called
Field<double> make_load(const cases::Scene& scene, bool is_quadratic, const Places& places);

} // namespace springproof::fem_reference::grid
