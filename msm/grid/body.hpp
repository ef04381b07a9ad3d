#pragma once

#include "mechanics/grid/field.hpp"
#include "msm/grid/kernels.hpp"
#include "msm/lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace springproof::msm::grid {

/// The springs of one cell of a grid. A coarser cell need not be a cube: its edges differ, and its face
/// diagonals.
struct CellSprings {
  std::array<double, 3> edge{};          ///< N/mm, along x, y, z
  std::array<double, 3> face_diagonal{}; ///< N/mm, in the planes yz, xz, xy
  double internal_diagonal = 0;          ///< N/mm
  double volume = 0;                     ///< k_v, MPa
  std::array<double, 3> midline{};       ///< N/mm, along x, y, z
  bool is_empty() const;
};

struct Body;

/// The other ranks, as a part of a grid sees them. Every function is collective.
class Ranks {
 public:
  virtual ~Ranks() = default;
  /// Ghost nodes of a field (three arrays of the part's layout) get their owners' values.
  virtual void update_ghosts(double* field) const = 0;
  virtual void update_ghosts(float* field) const = 0;
  /// Sums over the ranks, in place: the same ones on every rank.
  virtual void sum(double* values, std::size_t n) const = 0;
  virtual void sum(float* values, std::size_t n) const = 0;
  virtual double largest(double value) const = 0;
};

/// One rank's part of a grid: a box of nodes that it owns, and around it, where the grid goes
/// on, one layer of nodes that others own (ghosts), with the cells between. So every spring and every cell at
/// an own node is here. Fields of all operators have their owners' values on ghosts, so that sums of fields
/// need no messages; what adds up over nodes or springs counts own ones alone.
struct Part {
  std::array<int, 3> first;               ///< node of the whole grid that is the part's node 0
  std::array<int, 3> own_first, own_last; ///< own nodes are first to last - 1, in the part's numbers
  std::array<int, 3> whole_nodes;         ///< nodes of the whole grid
  std::shared_ptr<const Ranks> ranks;
  /// The next coarser body: a part again, or the whole of it, which every rank then has.
  std::shared_ptr<const Body> coarser;
  /// If that is whole: its nodes at and around this part, with own ones as for parts.
  std::shared_ptr<const Body> coarser_here;

  bool owns(int i, int j, int k) const {
    return i >= own_first[0] && i < own_last[0] && j >= own_first[1] && j < own_last[1] &&
           k >= own_first[2] && k < own_last[2];
  }
};

/// A body made of the cells of a grid, and what holds it.
struct Body {
  std::array<int, 3> cells;
  Eigen::Vector3d spacing;          ///< mm
  std::vector<CellSprings> springs; ///< one per cell, x fastest, all 0 where there is none; or one for all
  Layout layout;
  std::vector<std::ptrdiff_t> constrained; ///< entries of a field that never change: constrained dofs, and
                                           ///< entries without a cell. Sorted.
  std::optional<Part> part{};              ///< set when other ranks have the rest of the grid
  std::optional<Exponents> exponents{};    ///< power-log springs'; none: Hooke's law

  bool is_uniform() const { return springs.size() == 1; }
  const CellSprings& cell(int i, int j, int k) const;
};

/// One ghost node lies between two rows, so that the kernels run through the rows of a plane as through one;
/// ghosts enough for a neighbouring row and a pack of numbers more lie before and after every plane. Ghosts
/// never move and carry no spring.
Layout make_layout(const std::array<int, 3>& cells);

/// Fills in layout and constrained.
void set_layout(Body& body, const std::function<bool(int i, int j, int k, int component)>& is_constrained);

/// Whether a node touches a cell that is here.
bool has_cell(const Body& body, int i, int j, int k);

/// The same body in cells of twice the edge along those axes whose spacing is (almost) the smallest, so that
/// cells tend to cubes; nothing when it is as coarse as it gets. A coarse spring has the energy of the fine
/// ones in the same uniform strain; cells that are half outside have half the stiffness. A node is held where
/// the fine node at its place is. For a part, returns the coarser body that it brings.
std::optional<Body> coarsen(const Body& fine);

/// Whether a body at rest resists every motion for a reason that counting shows: the 28 springs of a cell
/// hold all distances between its vertices, cells that share a face share points that are not on a line and
/// move as one, and each piece that hangs together by faces is held at three such points at least. It is not
/// the only reason why a body may: false says nothing. Stiffnesses of less than a thousandth of the largest,
/// or negative ones, do not count; for a part of a body the answer is false.
bool is_rigid_by_faces(const Body& body);

/// The part of a whole body with own nodes first to last - 1 along each axis; ranks and coarser bodies are
/// not filled in.
Body cut_out(const Body& whole, const std::array<int, 3>& first, const std::array<int, 3>& last);

/// Ghosts and constrained entries are 0.
using mechanics::grid::Field;

using mechanics::grid::add;
using mechanics::grid::add_product;
using mechanics::grid::for_each_piece;
using mechanics::grid::for_each_place;
using mechanics::grid::for_each_plane;
using mechanics::grid::piece;

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

/// Returns the dot product over the nodes of the whole grid.
template<class Real>
double dot(const Body& body, const Field<Real>& a, const Field<Real>& b, int n_threads) {
  if (body.part) return detail::dot_of_parts(body, a, b);
  constexpr std::ptrdiff_t at_once = 64 * piece; // pieces whose sums lie on the stack
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

/// Whether no two neighbours' displacements differ by midpoint_below of their distance.
/// @param displacement  mm, on this rank's nodes and ghosts
bool is_small(const Body& body, const Field<double>& displacement);

/// As mechanics::grid::random_field(), but 0 on constrained entries.
template<class Real, class Distribution>
Field<Real> random_field(const Body& body, unsigned seed, const Distribution& any_value) {
  const std::array<int, 3> first = body.part ? body.part->first : std::array<int, 3>{0, 0, 0};
  Field<Real> field = mechanics::grid::random_field<Real>(body.layout, first, seed, any_value);
  clear_constrained(body, field);
  return field;
}

} // namespace springproof::msm::grid
