#pragma once

#include "fem_reference/grid/slab.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace springproof::fem_reference::grid {

/// Three arrays of a layout: a vector at every node of a grid.
template<class Real>
using Field = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Pieces of a field for threads.
constexpr std::ptrdiff_t piece = 1 << 14;

/// Calls action(first, length) for the pieces of n entries on n_threads threads.
template<class Action>
void for_each_piece(std::ptrdiff_t n, int n_threads, const Action& action) {
  const std::ptrdiff_t n_pieces = (n + piece - 1) / piece;
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n_threads > 1 && n_pieces > 1)
  for (std::ptrdiff_t p = 0; p < n_pieces; ++p) action(p * piece, std::min(piece, n - p * piece));
}

/// a += factor * b
template<class Real>
void add(Field<Real>& a, Real factor, const Field<Real>& b, int n_threads) {
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    a.segment(first, n) += factor * b.segment(first, n);
  });
}

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
  const auto [begin, end] = space.slab.computed();
  std::vector<double> of_planes(static_cast<std::size_t>(end - begin));
  for_each_plane({begin, end}, space.n_threads, [&](int k) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      const std::ptrdiff_t at = c * space.layout.size + space.layout.at(0, 0, k), n = space.layout.plane;
      sum += static_cast<double>(a.segment(at, n).dot(b.segment(at, n).template cast<Real>()));
    }
    of_planes[static_cast<std::size_t>(k - begin)] = sum;
  });
  return space.slab.total(of_planes);
}
template<class Real>
double norm(const Space& space, const Field<Real>& a) {
  return std::sqrt(dot(space, a, a));
}

} // namespace springproof::fem_reference::grid
