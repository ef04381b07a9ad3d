#pragma once

#include "msm/grid/body.hpp"

#include <algorithm>
#include <cmath>
#include <random>

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

/// Calls action(k) for the planes of nodes on n_threads threads.
template<class Action>
void for_each_plane(const Layout& layout, int n_threads, const Action& action) {
#pragma omp parallel for num_threads(n_threads) schedule(static) if (n_threads > 1 && layout.size > piece)
  for (int k = 0; k < layout.nodes[2]; ++k) action(k);
}

template<class Real>
double dot(const Field<Real>& a, const Field<Real>& b, int n_threads) {
  Eigen::VectorXd part((a.size() + piece - 1) / piece);
  for_each_piece(a.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length) {
    part[first / piece] = static_cast<double>(a.segment(first, length).dot(b.segment(first, length)));
  });
  double sum = 0;
  for (const double value : part) sum += value;
  return sum;
}

template<class Real>
double norm(const Field<Real>& a, int n_threads) {
  return std::sqrt(dot(a, a, n_threads));
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

/// Random numbers, the same ones every time: a field with a part in every motion of the body.
template<class Real, class Distribution>
Field<Real> random_field(const Body& body, unsigned seed, Distribution any_value) {
  Field<Real> field = Field<Real>::Zero(3 * body.layout.size);
  std::mt19937 generator(seed);
  for (int c = 0; c < 3; ++c)
    for_each_place(body.layout.nodes, [&](int i, int j, int k) {
      field[body.layout.at(i, j, k, c)] = static_cast<Real>(any_value(generator));
    });
  clear_constrained(body, field);
  return field;
}

} // namespace springproof::msm::grid
