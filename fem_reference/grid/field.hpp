#pragma once

#include "fem_reference/grid/kernels.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace springproof::fem_reference::grid {

/// Three arrays of a layout: a vector at every node of a grid.
template<class Real>
using Field = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Fixed pieces of a field: sums add piece by piece in order, so that they do not depend on the number of
/// threads.
constexpr std::ptrdiff_t piece = 1 << 14;

/// Calls action(first, length) for the pieces of n entries on n_threads threads.
template<class Action>
void for_each_piece(std::ptrdiff_t n, int n_threads, const Action& action) {
  const std::ptrdiff_t n_pieces = (n + piece - 1) / piece;
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n_threads > 1 && n_pieces > 1)
  for (std::ptrdiff_t p = 0; p < n_pieces; ++p) action(p * piece, std::min(piece, n - p * piece));
}

template<class Real>
double dot(const Field<Real>& a, const Field<Real>& b, int n_threads) {
  Eigen::VectorXd part((a.size() + piece - 1) / piece);
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    part[first / piece] = static_cast<double>(a.segment(first, n).dot(b.segment(first, n)));
  });
  double sum = 0;
  for (double value : part) sum += value;
  return sum;
}

/// a += factor * b
template<class Real>
void add(Field<Real>& a, Real factor, const Field<Real>& b, int n_threads) {
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    a.segment(first, n) += factor * b.segment(first, n);
  });
}

/// Calls action(plane) for planes 0 to n - 1 on n_threads threads; which planes are neighbours does not
/// matter.
template<class Action>
void for_each_plane(int n, int n_threads, const Action& action) {
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n_threads > 1)
  for (int k = 0; k < n; ++k) action(k);
}

/// Calls action(layer) for layers of cells, first the even ones and then the odd ones: those add to different
/// planes of nodes, and always in the same order.
template<class Action>
void for_each_layer(int n, int n_threads, const Action& action) {
  for (int first : {0, 1})
    for_each_plane((n - first + 1) / 2, n_threads, [&](int half) { action(2 * half + first); });
}

} // namespace springproof::fem_reference::grid
