#pragma once

#include "fem_reference/grid/body.hpp"

#include <Eigen/Core>

namespace springproof::fem_reference::grid {

using Place = Eigen::Vector3i; ///< of a node in its grid

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
  /// Of a node that is held.
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

} // namespace springproof::fem_reference::grid
