#pragma once

#include "fem_reference/grid/slab.hpp"
#include "mechanics/grid/transfer.hpp"

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
  mechanics::grid::for_each_plane(planes.begin, planes.end, n_threads, action);
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
