#pragma once

#include "fem_reference/grid/kernels.hpp"
#include "mechanics/grid/transfer.hpp"

#include <algorithm>
#include <cmath>
#include <mpi.h>
#include <vector>

namespace springproof::fem_reference::grid {

/// The planes of nodes of a grid that a rank holds: its own ones, which it computes, and one more on either
/// side, so that it holds all cells that touch its own nodes. Planes and layers of cells are numbered from
/// the first that is held; where a name says `of_grid`, from the grid's first.
class Slab {
 public:
  /// Makes a slab of all planes, which each rank computes for itself.
  explicit Slab(int n_planes);
  /// Deals planes out to the ranks of a communicator, about the same number to each. Where they are few, each
  /// rank has all of them.
  /// @param multiple  each rank's first plane is a multiple of it
  Slab(int n_planes, MPI_Comm communicator, int multiple = 1);
  /// Returns the slab of a grid with every second plane of this one, or with all of them. A rank computes a
  /// coarse plane if it has the fine one, and a coarse layer if it has all of its fine layers.
  /// @param is_gathered  every rank holds the whole coarse grid, and computes all of it for itself; only what
  ///                     comes from the finer one is computed in parts, and completed by complete_*()
  Slab coarser(bool along_z, bool is_gathered) const;

  struct Range {
    int begin, end;
  };
  int first_of_grid() const { return first_; } ///< plane, and layer
  int n_planes() const { return n_held_; }
  int n_layers() const { return n_held_ - 1; }
  int n_planes_of_grid() const { return begins_.back(); }
  /// Planes in which fields are computed; all others are ghosts.
  Range computed() const { return is_gathered_ ? Range{0, n_held_} : own(); }
  /// Planes, and layers, which this rank alone makes from a finer grid.
  Range own() const;
  Range own_layers() const;
  /// Whether others compute other planes.
  bool is_shared() const { return begins_.size() > 2 && !is_gathered_; }
  /// Whether each rank has enough planes to make a coarser grid of.
  bool can_be_halved() const;

  /// Brings the planes that others own up to date: the ghosts, or all of a gathered grid.
  /// @param field  three components
  template<class Real>
  void complete(const Layout& layout, Real* field) const;
  /// The same where every rank computes a gathered grid itself.
  template<class Real>
  void update_ghosts(const Layout& layout, Real* field) const {
    if (is_shared()) complete(layout, field);
  }
  /// Does the same as complete() for layers of `n` numbers each.
  template<class Real>
  void complete_layers(Real* layers, std::ptrdiff_t n) const;
  /// Adds this rank's sums in the next rank's first own plane to that plane on the next rank.
  void add_to_next(const Layout& layout, double* field) const;

  /// Largest value and sum over the ranks that share the grid.
  double largest(double value) const;
  double total(double value) const;
  /// Sum of one number of every computed plane, in their order: it does not depend on the number of ranks.
  double total(const std::vector<double>& of_planes) const;

 private:
  std::vector<int> begins_, layer_begins_; ///< each rank's first own one in the grid; last, their number
  int rank_ = 0;
  MPI_Comm communicator_ = MPI_COMM_SELF;
  bool is_gathered_ = false;
  int first_ = 0, n_held_ = 0;

  void hold();
  int begin(int rank) const { return begins_[static_cast<std::size_t>(rank)]; }
  int layer_begin(int rank) const { return layer_begins_[static_cast<std::size_t>(rank)]; }
  int n_ranks() const { return static_cast<int>(begins_.size()) - 1; }
  int below() const { return rank_ > 0 ? rank_ - 1 : MPI_PROC_NULL; }
  int above() const { return rank_ + 1 < n_ranks() ? rank_ + 1 : MPI_PROC_NULL; }
  template<class Real>
  std::vector<Real> exchange(const std::vector<Real>& sent, int to, int from) const;
};

/// A grid's fields: where their entries lie, which of them are computed here, and by how many threads.
struct Space {
  Layout layout;
  Slab slab;
  int n_threads;
};

using mechanics::grid::add;
using mechanics::grid::Field;
using mechanics::grid::for_each_piece;
using mechanics::grid::piece;

/// Calls action(plane), or layer, for a range of them on n_threads threads; which are neighbours does not
/// matter.
template<class Action>
void for_each_plane(const Slab::Range& planes, int n_threads, const Action& action) {
  mechanics::grid::for_each_plane(planes.begin, planes.end, n_threads, action);
}

/// Calls action(layer) for the layers of cells held.
template<class Action>
void for_each_layer(const Slab& slab, int n_threads, const Action& action) {
  mechanics::grid::for_each_layer(slab.n_layers(), slab.first_of_grid(), n_threads, action);
}

/// Calls kernel(layer, its checks) for the layers of cells held, as for_each_layer().  @return all checks
template<class Kernel>
Checks check_layers(const Slab& slab, int n_threads, const Kernel& kernel) {
  std::vector<Checks> checks(static_cast<std::size_t>(slab.n_layers()));
  for_each_layer(slab, n_threads, [&](int k) { kernel(k, checks[static_cast<std::size_t>(k)]); });
  Checks all;
  for (const Checks& layer : checks) {
    all.valid = all.valid && layer.valid;
    all.volume_mismatch = std::max(all.volume_mismatch, layer.volume_mismatch);
  }
  return all;
}

/// Sum over the nodes of the grid. The numbers of a plane are summed first, so that the result depends on the
/// number of neither threads nor ranks.
template<class Real, class Other>
double dot(const Space& space, const Field<Real>& a, const Field<Other>& b) {
  const Slab::Range planes = space.slab.computed();
  std::vector<double> of_planes(static_cast<std::size_t>(planes.end - planes.begin));
  for_each_plane(planes, space.n_threads, [&](int k) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      const std::ptrdiff_t at = c * space.layout.size + space.layout.at(0, 0, k), n = space.layout.plane;
      sum += static_cast<double>(a.segment(at, n).dot(b.segment(at, n).template cast<Real>()));
    }
    of_planes[static_cast<std::size_t>(k - planes.begin)] = sum;
  });
  return space.slab.total(of_planes);
}
template<class Real>
double norm(const Space& space, const Field<Real>& a) {
  return std::sqrt(dot(space, a, a));
}

/// Trilinear interpolation between a slab of a grid and that of the coarser one, and its transpose. Ghosts of
/// both fields are brought up to date.
template<class Real>
class Transfer {
 public:
  Transfer(const Space& fine, const Space& coarse, const std::array<int, 3>& factor)
      : fine_(fine), coarse_(coarse),
        interpolation_(fine.layout, coarse.layout, factor,
                       {0, 0, factor[2] * coarse.slab.first_of_grid() - fine.slab.first_of_grid()},
                       fine.n_threads) {}

  void prolong(Field<Real>& coarse, Field<Real>& fine) const {
    coarse_.slab.update_ghosts(coarse_.layout, coarse.data());
    interpolation_.prolong(coarse, fine);
  }
  void restrict(Field<Real>& fine, Field<Real>& coarse) const {
    fine_.slab.update_ghosts(fine_.layout, fine.data());
    const auto [begin, end] = coarse_.slab.own();
    interpolation_.restrict(fine, coarse, begin, end);
    coarse_.slab.complete(coarse_.layout, coarse.data());
  }

 private:
  Space fine_, coarse_;
  mechanics::grid::Interpolation<Real> interpolation_;
};

} // namespace springproof::fem_reference::grid
