#pragma once

#include "msm/grid/kernels.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

namespace springproof::msm::grid {

/// Calls action(i, j, k) for all of n[0] * n[1] * n[2] cells or nodes, x fastest.
template<class Counts, class Action>
void for_each_place(const Counts& n, const Action& action) {
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) action(i, j, k);
}

/// The springs of one cell of a grid. A coarser cell need not be a cube: its edges differ, and its face
/// diagonals.
struct CellSprings {
  std::array<double, 3> edge{};          ///< along x, y, z, N/mm
  std::array<double, 3> face_diagonal{}; ///< in the planes yz, xz, xy, N/mm
  double internal_diagonal = 0;          ///< N/mm
  double volume = 0;                     ///< k_v, MPa
  bool is_empty() const;
};

/// A body made of the cells of a grid, and what holds it.
struct Body {
  std::array<int, 3> cells;
  Eigen::Vector3d spacing;          ///< mm
  std::vector<CellSprings> springs; ///< of every cell, x fastest, all 0 where there is none; or one for all
  Layout layout;
  std::vector<std::ptrdiff_t> constrained; ///< entries of a field that never change: constrained dofs, and
                                           ///< entries without a cell. Sorted.

  bool is_uniform() const { return springs.size() == 1; }
  const CellSprings& cell(int i, int j, int k) const;
};

Layout make_layout(const std::array<int, 3>& cells);

/// Fills in layout and constrained.
void set_layout(Body& body, const std::function<bool(int i, int j, int k, int component)>& is_constrained);

/// Whether a node touches a cell.
bool has_cell(const Body& body, int i, int j, int k);

/// The same body in cells of twice the edge along those axes whose spacing is (almost) the smallest, so that
/// cells tend to cubes; nothing when it is as coarse as it gets. A coarse spring has the energy of the fine
/// ones in the same uniform strain; cells that are half outside have half the stiffness. A node is held where
/// the fine node at its place is.
std::optional<Body> coarsen(const Body& fine);

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
