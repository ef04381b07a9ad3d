#pragma once

#include "msm/grid/body.hpp"

#include <Eigen/Core>
#include <algorithm>

namespace springproof::msm::grid {

/// Three arrays of a layout: a vector at every node of a grid. Ghosts and constrained entries are 0.
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

template<class Action>
double sum_pieces(std::ptrdiff_t n, int n_threads, const Action& action) {
  Eigen::VectorXd part((n + piece - 1) / piece);
  for_each_piece(n, n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    part[first / piece] = action(first, length);
  });
  double sum = 0;
  for (double value : part) sum += value;
  return sum;
}

template<class Real>
double dot(const Field<Real>& a, const Field<Real>& b, int n_threads) {
  return sum_pieces(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    return static_cast<double>(a.segment(first, length).dot(b.segment(first, length)));
  });
}

/// a += factor * b
template<class Real>
void add(Field<Real>& a, Real factor, const Field<Real>& b, int n_threads) {
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    a.segment(first, length) += factor * b.segment(first, length);
  });
}

template<class Real>
void clear_constrained(const Body& body, Field<Real>& field) {
  for (const std::ptrdiff_t entry : body.constrained) field[entry] = 0;
}

} // namespace springproof::msm::grid
