#pragma once

#include "fem_reference/grid/slab.hpp"
#include "mechanics/grid/field.hpp"

#include <cmath>

namespace springproof::fem_reference::grid {

using mechanics::grid::add;
using mechanics::grid::Field;
using mechanics::grid::for_each_piece;
using mechanics::grid::piece;

/// Calls action(plane), or layer, for a range of them on n_threads threads; which are neighbours does not
/// matter.
template<class Action>
void for_each_plane(const Slab::Range& planes, int n_threads, const Action& action) {
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n_threads > 1)
  for (int k = planes.begin; k < planes.end; ++k) action(k);
}

/// Calls action(layer) for the layers of cells held, first the even ones of the grid and then the odd ones:
/// those add to different planes of nodes, and always in the same order.
template<class Action>
void for_each_layer(const Slab& slab, int n_threads, const Action& action) {
  const int n = slab.n_layers(), first_even = slab.first_of_grid() % 2;
  for (int first : {first_even, 1 - first_even})
    for_each_plane({0, (n - first + 1) / 2}, n_threads, [&](int half) { action(2 * half + first); });
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

} // namespace springproof::fem_reference::grid
