#pragma once

#include "fem_reference/grid/kernels.hpp"

#include <array>
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
};

/// A grid's fields: where their entries lie, which of them are computed here, and by how many threads.
struct Space {
  Layout layout;
  Slab slab;
  int n_threads;
};

} // namespace springproof::fem_reference::grid
