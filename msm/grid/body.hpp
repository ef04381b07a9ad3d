#pragma once

#include "mechanics/grid/field.hpp"
#include "msm/grid/kernels.hpp"
#include "msm/grid/part.hpp"
#include "msm/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
  std::optional<Part> part{};              ///< set when other ranks have the rest of the grid
  std::optional<Exponents> exponents{};    ///< of power-log springs; none: Hooke's

  bool is_uniform() const { return springs.size() == 1; }
  const CellSprings& cell(int i, int j, int k) const;
};

Layout make_layout(const std::array<int, 3>& cells);

/// Fills in layout and constrained.
void set_layout(Body& body, const std::function<bool(int i, int j, int k, int component)>& is_constrained);

/// Whether a node touches a cell that is here.
bool has_cell(const Body& body, int i, int j, int k);

/// How many cells along each axis a coarser one has: 2 along those whose spacing is (almost) the smallest, so
/// that cells tend to cubes, 1 along the others; nothing where no axis has more than two cells.
std::optional<std::array<int, 3>> coarsening_factor(const std::array<int, 3>& cells,
                                                    const Eigen::Vector3d& spacing);

/// The same body in cells of twice the edge along those axes whose spacing is (almost) the smallest, so that
/// cells tend to cubes; nothing when it is as coarse as it gets. A coarse spring has the energy of the fine
/// ones in the same uniform strain; cells that are half outside have half the stiffness. A node is held where
/// the fine node at its place is. Of a part, the coarser body that it brings.
std::optional<Body> coarsen(const Body& fine);

/// Ghosts and constrained entries are 0.
using mechanics::grid::Field;

using mechanics::grid::add;
using mechanics::grid::add_product;
using mechanics::grid::for_each_piece;
using mechanics::grid::piece;

/// Calls action(k) for the planes of nodes on n_threads threads.
template<class Action>
void for_each_plane(const Layout& layout, int n_threads, const Action& action) {
  if (n_threads == 1 || layout.size <= piece) { // a parallel region of one thread allocates
    for (int k = 0; k < layout.nodes[2]; ++k) action(k);
    return;
  }
#pragma omp parallel for num_threads(n_threads) schedule(static)
  for (int k = 0; k < layout.nodes[2]; ++k) action(k);
}

namespace detail {

template<class Real>
double dot_of_parts(const Body& body, const Field<Real>& a, const Field<Real>& b) {
  const Part& part = *body.part;
  const int n = part.own_last[0] - part.own_first[0];
  double sum = 0;
  for (int c = 0; c < 3; ++c)
    for (int k = part.own_first[2]; k < part.own_last[2]; ++k)
      for (int j = part.own_first[1]; j < part.own_last[1]; ++j) {
        const std::ptrdiff_t row = body.layout.at(part.own_first[0], j, k, c);
        sum += static_cast<double>(a.segment(row, n).dot(b.segment(row, n)));
      }
  part.ranks->sum(&sum, 1);
  return sum;
}

inline double dot_of_piece(const double* a, const double* b, std::ptrdiff_t n) {
  return mechanics::grid::dot(a, b, n);
}
inline double dot_of_piece(const float* a, const float* b, std::ptrdiff_t n) {
  return static_cast<double>(Eigen::Map<const Field<float>>(a, n).dot(Eigen::Map<const Field<float>>(b, n)));
}

} // namespace detail

/// Over the nodes of the whole grid.
template<class Real>
double dot(const Body& body, const Field<Real>& a, const Field<Real>& b, int n_threads) {
  if (body.part) return detail::dot_of_parts(body, a, b);
  constexpr std::ptrdiff_t at_once = 64 * piece; // what the parts of lie on the stack
  double sum = 0;
  for (std::ptrdiff_t start = 0; start < a.size(); start += at_once) {
    std::array<double, 64> part{};
    for_each_piece(std::min(at_once, a.size() - start), n_threads,
                   [&](std::ptrdiff_t first, std::ptrdiff_t n) {
                     part[static_cast<std::size_t>(first / piece)] =
                         detail::dot_of_piece(a.data() + start + first, b.data() + start + first, n);
                   });
    for (const double value : part) sum += value;
  }
  return sum;
}

template<class Real>
double norm(const Body& body, const Field<Real>& a, int n_threads) {
  return std::sqrt(dot(body, a, a, n_threads));
}

/// Ghost nodes of a part get their owners' values.
template<class Real>
void update_ghosts(const Body& body, Field<Real>& field) {
  if (body.part) body.part->ranks->update_ghosts(field.data());
}

/// Whether something holds on all ranks.
inline bool on_all_ranks(const Body& body, bool here) {
  double n_not = here ? 0 : 1;
  if (body.part) body.part->ranks->sum(&n_not, 1);
  return n_not == 0;
}

template<class Real>
void clear_constrained(const Body& body, Field<Real>& field) {
  for (const std::ptrdiff_t entry : body.constrained) field[entry] = 0;
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

/// Whether no two neighbours' displacements differ by midpoint_below of their distance.
/// @param displacement  of this rank's nodes and ghosts, mm
bool is_small(const Body& body, const Field<double>& displacement);

/// Random numbers, the same ones every time and on any number of ranks: a field with a part in every motion
/// of the body.
template<class Real, class Distribution>
Field<Real> random_field(const Body& body, unsigned seed, Distribution any_value) {
  Field<Real> field = Field<Real>::Zero(3 * body.layout.size);
  const auto& [rows_x, rows_y, rows_z] = body.layout.nodes;
  const std::array<int, 3> first = body.part ? body.part->first : std::array<int, 3>{0, 0, 0};
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < rows_z; ++k)
      for (int j = 0; j < rows_y; ++j) {
        SplitMix generator{
            (((seed * std::uint64_t{3} + std::uint64_t(c)) << 24 | std::uint64_t(first[2] + k)) << 24) |
            std::uint64_t(first[1] + j)};
        any_value.reset();
        for (int i = -first[0]; i < rows_x; ++i) {
          const auto value = static_cast<Real>(any_value(generator));
          if (i >= 0) field[body.layout.at(i, j, k, c)] = value;
        }
      }
  clear_constrained(body, field);
  return field;
}

} // namespace springproof::msm::grid
