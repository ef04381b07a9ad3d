#pragma once

#include "mechanics/grid/layout.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

/// What the matrix-free solvers of both models share.
namespace springproof::mechanics::grid {

/// Three arrays of a grid's layout: a vector at every node.
template<class Real>
using Field = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

/// Calls action(i, j, k) for all of n[0] * n[1] * n[2] cells or nodes, x fastest.
template<class Counts, class Action>
void for_each_place(const Counts& n, const Action& action) {
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) action(i, j, k);
}

// Loops over plain arrays, compiled for the widest instructions too: which ones run is decided when the
// program starts. The same bits with all of them (loops.cpp).

/// a += factor * b
void add(double* a, double factor, const double* b, std::ptrdiff_t n);
void add(float* a, float factor, const float* b, std::ptrdiff_t n);

/// a += b * c, entry by entry
void add_product(double* a, const double* b, const double* c, std::ptrdiff_t n);
void add_product(float* a, const float* b, const float* c, std::ptrdiff_t n);

/// a = b + factor * a
void scale_and_add(double* a, double factor, const double* b, std::ptrdiff_t n);
void scale_and_add(float* a, float factor, const float* b, std::ptrdiff_t n);

double dot(const double* a, const double* b, std::ptrdiff_t n);

/// out = keep * out + factor * (blocks) in, for the first n nodes.
/// @param blocks  symmetric 3x3 blocks, one for each node: six arrays xx, yy, zz, yz, xz, xy
/// @param size    distance from one array to the next
void apply_blocks(const float* blocks, const float* in, float* out, std::ptrdiff_t size, float keep,
                  float factor, std::ptrdiff_t n);

/// Calls action(i) for i = 0 ... n - 1 on n_threads threads.
/// @param at_once  how many a thread takes one after the other; 0: all of its own
template<class Action>
void on_threads(std::ptrdiff_t n, int n_threads, const Action& action, std::ptrdiff_t at_once = 0) {
  if (n_threads == 1 || n <= std::max<std::ptrdiff_t>(1, at_once)) { // a region of one thread allocates
    for (std::ptrdiff_t i = 0; i < n; ++i) action(i);
    return;
  }
  const std::ptrdiff_t chunk = at_once > 0 ? at_once : (n + n_threads - 1) / n_threads;
#pragma omp parallel for num_threads(n_threads) schedule(static, chunk)
  for (std::ptrdiff_t i = 0; i < n; ++i) action(i);
}

/// Fixed pieces of a field: sums that add piece by piece in order do not depend on the number of threads.
constexpr std::ptrdiff_t piece = 1 << 14;

/// Calls action(first, length) for the pieces of n entries on n_threads threads.
template<class Action>
void for_each_piece(std::ptrdiff_t n, int n_threads, const Action& action) {
  on_threads((n + piece - 1) / piece, n_threads,
             [&](std::ptrdiff_t p) { action(p * piece, std::min(piece, n - p * piece)); });
}

/// Entries of an array of nodes from which on sweeps of a grid, some hundred operations a node, are worth
/// several threads.
constexpr std::ptrdiff_t worth_threads = 1 << 12;

/// Calls action(k) for planes, or layers, from begin to end - 1 on n_threads threads.
template<class Action>
void for_each_plane(int begin, int end, int n_threads, const Action& action) {
  on_threads(end - begin, n_threads, [&](std::ptrdiff_t k) { action(begin + static_cast<int>(k)); });
}
/// The same for all planes of nodes.
template<class Action>
void for_each_plane(const Layout& layout, int n_threads, const Action& action) {
  for_each_plane(0, layout.nodes[2], layout.size <= worth_threads ? 1 : n_threads, action);
}

/// Calls action(layer) for n layers of cells, first the even ones of the grid and then the odd ones: those
/// add to different planes of nodes, and always in the same order.
/// @param first  number in the grid of the first layer
template<class Action>
void for_each_layer(int n, int first, int n_threads, const Action& action) {
  const int first_even = first % 2;
  for (int begin : {first_even, 1 - first_even})
    for_each_plane(0, (n - begin + 1) / 2, n_threads, [&](int half) { action(2 * half + begin); });
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

/// A generator that is cheap to seed, as every row of a field is (Steele, Lea, Flood 2014).
struct SplitMix {
  using result_type = std::uint64_t;
  std::uint64_t state;
  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }
  result_type operator()() {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
};

/// Returns a random field, the same every time and on any number of ranks, with a part in every motion of
/// the body.
/// @param first  number in the whole grid of the layout's node 0
template<class Real, class Distribution>
Field<Real> random_field(const Layout& layout, const std::array<int, 3>& first, unsigned seed,
                         Distribution any_value) {
  Field<Real> field = Field<Real>::Zero(3 * layout.size);
  const auto& [rows_x, rows_y, rows_z] = layout.nodes;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < rows_z; ++k)
      for (int j = 0; j < rows_y; ++j) {
        SplitMix generator{
            (((seed * std::uint64_t{3} + std::uint64_t(c)) << 24 | std::uint64_t(first[2] + k)) << 24) |
            std::uint64_t(first[1] + j)};
        any_value.reset();
        for (int i = -first[0]; i < rows_x; ++i) {
          const auto value = static_cast<Real>(any_value(generator));
          if (i >= 0) field[layout.at(i, j, k, c)] = value;
        }
      }
  return field;
}

} // namespace springproof::mechanics::grid
