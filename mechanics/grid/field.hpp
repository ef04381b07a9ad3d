#pragma once

#include "mechanics/grid/loops.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

/// What the matrix-free solvers of both models share.
namespace springproof::mechanics::grid {

/// Three arrays of a grid's layout: a vector at every node.
template<class Real>
using Field = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Fixed pieces of a field: sums that add piece by piece in order do not depend on the number of threads.
constexpr std::ptrdiff_t piece = 1 << 14;

/// Calls action(first, length) for the pieces of n entries on n_threads threads.
template<class Action>
void for_each_piece(std::ptrdiff_t n, int n_threads, const Action& action) {
  const std::ptrdiff_t n_pieces = (n + piece - 1) / piece;
  const auto run = [&](std::ptrdiff_t p) { action(p * piece, std::min(piece, n - p * piece)); };
  if (n_threads == 1 || n_pieces == 1) { // a parallel region of one thread allocates
    for (std::ptrdiff_t p = 0; p < n_pieces; ++p) run(p);
    return;
  }
#pragma omp parallel for num_threads(n_threads) schedule(static)
  for (std::ptrdiff_t p = 0; p < n_pieces; ++p) run(p);
}

/// a += factor * b
template<class Real>
void add(Field<Real>& a, Real factor, const Field<Real>& b, int n_threads) {
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    add(a.data() + first, factor, b.data() + first, n);
  });
}

/// a += b * c, entry by entry
template<class Real>
void add_product(Field<Real>& a, const Field<Real>& b, const Field<Real>& c, int n_threads) {
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
    add_product(a.data() + first, b.data() + first, c.data() + first, n);
  });
}

} // namespace springproof::mechanics::grid
