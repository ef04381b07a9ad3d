#include "msm/grid/body.hpp"

#include "cases/mesh/mesh.hpp"
#include "mechanics/grid/transfer.hpp"

#include <Eigen/Geometry>

namespace springproof::msm::grid {

using cases::index;

namespace {

/// Held points of a piece, as far as they are needed: three that are not on a line.
struct Held {
  std::array<Eigen::Vector3i, 3> points{};
  int n = 0;
  void add(const Eigen::Vector3i& point) {
    if (n == 3 || (n > 0 && point == points[0])) return;
    if (n == 2 && (points[1] - points[0]).cross(point - points[0]).isZero()) return;
    points[index(n++)] = point;
  }
};

bool has_all_springs(const Body& body) {
  double largest = 0, smallest = INFINITY;
  for (const CellSprings& cell : body.springs) {
    if (cell.is_empty()) continue;
    if (cell.volume < 0) return false;
    for (const double k : {cell.edge[0], cell.edge[1], cell.edge[2], cell.face_diagonal[0],
                           cell.face_diagonal[1], cell.face_diagonal[2], cell.internal_diagonal}) {
      largest = std::max(largest, k);
      smallest = std::min(smallest, k);
    }
  }
  constexpr double nothing = 1e-290; // N/mm: its square is none
  return smallest > nothing && smallest >= 1e-3 * largest;
}

} // namespace

bool CellSprings::is_empty() const {
  const std::array<double, 3> none{};
  return edge == none && face_diagonal == none && midline == none && internal_diagonal == 0 && volume == 0;
}

const CellSprings& Body::cell(int i, int j, int k) const {
  static const CellSprings none;
  if (i < 0 || j < 0 || k < 0 || i >= cells[0] || j >= cells[1] || k >= cells[2]) return none;
  return is_uniform() ? springs.front() : springs[index(i + cells[0] * (j + std::ptrdiff_t{cells[1]} * k))];
}

Layout make_layout(const std::array<int, 3>& cells) {
  Layout layout;
  for (int a = 0; a < 3; ++a) layout.nodes[a] = cells[index(a)] + 1;
  const auto in_packs = [](std::ptrdiff_t n) { return (n + 15) / 16 * 16; };
  layout.row = layout.nodes[0] + 1;
  layout.plane = in_packs(layout.row * (layout.nodes[1] + 1) + 48);
  layout.lead = layout.plane + in_packs(layout.row + 16);
  layout.size = layout.lead + layout.plane * (layout.nodes[2] + 1) + 32;
  return layout;
}

void set_layout(Body& body, const std::function<bool(int, int, int, int)>& is_constrained) {
  body.layout = make_layout(body.cells);
  body.constrained.clear();
  for (int c = 0; c < 3; ++c)
    for_each_place(body.layout.nodes, [&](int i, int j, int k) {
      if (is_constrained(i, j, k, c) || !has_cell(body, i, j, k))
        body.constrained.push_back(body.layout.at(i, j, k, c));
    });
}

bool has_cell(const Body& body, int i, int j, int k) {
  if (body.is_uniform()) return true;
  for (int v = 0; v < 8; ++v)
    if (!body.cell(i - (v & 1), j - ((v >> 1) & 1), k - (v >> 2)).is_empty()) return true;
  return false;
}

std::optional<Body> coarsen(const Body& fine) {
  if (fine.part) return *fine.part->coarser;
  const auto coarsening = mechanics::grid::coarsening_factor(fine.cells, fine.spacing);
  if (!coarsening) return std::nullopt;
  const std::array<int, 3>& factor = *coarsening;
  Body coarse;
  coarse.exponents = fine.exponents;
  bool divides = true;
  for (std::size_t a = 0; a < 3; ++a) {
    coarse.spacing[static_cast<int>(a)] = factor[a] * fine.spacing[static_cast<int>(a)];
    coarse.cells[a] = (fine.cells[a] + factor[a] - 1) / factor[a];
    divides = divides && fine.cells[a] % factor[a] == 0;
  }
  const Eigen::Vector3d h = fine.spacing.cwiseAbs2(), H = coarse.spacing.cwiseAbs2();
  const double volume_ratio = fine.spacing.prod() / coarse.spacing.prod();
  const auto gathered = [&](int i, int j, int k) {
    CellSprings sum;
    for_each_place(factor, [&](int x, int y, int z) {
      const CellSprings& part = fine.cell(factor[0] * i + x, factor[1] * j + y, factor[2] * k + z);
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        sum.edge[index(a)] += part.edge[index(a)] * h[a] / H[a];
        sum.midline[index(a)] += part.midline[index(a)] * h[a] / H[a];
        sum.face_diagonal[index(a)] += part.face_diagonal[index(a)] * (h[b] + h[c]) / (H[b] + H[c]);
      }
      sum.internal_diagonal += part.internal_diagonal * h.sum() / H.sum();
      sum.volume += part.volume * volume_ratio;
    });
    return sum;
  };
  for_each_place(fine.is_uniform() && divides ? std::array<int, 3>{1, 1, 1} : coarse.cells,
                 [&](int i, int j, int k) { coarse.springs.push_back(gathered(i, j, k)); });
  set_layout(coarse, [&](int i, int j, int k, int c) {
    const std::ptrdiff_t entry =
        fine.layout.at(std::min(factor[0] * i, fine.cells[0]), std::min(factor[1] * j, fine.cells[1]),
                       std::min(factor[2] * k, fine.cells[2]), c);
    return std::binary_search(fine.constrained.begin(), fine.constrained.end(), entry);
  });
  return coarse;
}

Body cut_out(const Body& whole, const std::array<int, 3>& first, const std::array<int, 3>& last) {
  Body here;
  here.spacing = whole.spacing;
  here.exponents = whole.exponents;
  Part part;
  std::array<int, 3> n_nodes;
  for (std::size_t a = 0; a < 3; ++a) {
    part.whole_nodes[a] = whole.layout.nodes[a];
    part.first[a] = std::max(first[a] - 1, 0);
    n_nodes[a] = std::min(last[a] + 1, part.whole_nodes[a]) - part.first[a];
    here.cells[a] = n_nodes[a] - 1;
    part.own_first[a] = first[a] - part.first[a];
    part.own_last[a] = last[a] - part.first[a];
  }
  if (whole.is_uniform())
    here.springs = whole.springs;
  else
    for_each_place(here.cells, [&](int i, int j, int k) {
      here.springs.push_back(whole.cell(part.first[0] + i, part.first[1] + j, part.first[2] + k));
    });
  here.layout = make_layout(here.cells);
  for (const std::ptrdiff_t entry : whole.constrained) {
    const auto [i, j, k, c] = whole.layout.place(entry);
    const std::array<int, 3> at{i - part.first[0], j - part.first[1], k - part.first[2]};
    const auto is_here = [&](std::size_t a) { return at[a] >= 0 && at[a] < n_nodes[a]; };
    if (is_here(0) && is_here(1) && is_here(2))
      here.constrained.push_back(here.layout.at(at[0], at[1], at[2], c));
  }
  here.part = std::move(part);
  return here;
}

bool is_small(const Body& body, const Field<double>& displacement) {
  const Layout& layout = body.layout;
  const std::ptrdiff_t to_next[3] = {1, layout.row, layout.plane};
  for (int axis = 0; axis < 3; ++axis) {
    const double least = midpoint_below * body.spacing[axis];
    std::array<int, 3> n{layout.nodes[0], layout.nodes[1], layout.nodes[2]};
    --n[index(axis)];
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j) {
          const double* const row = displacement.data() + layout.at(0, j, k, c);
          for (int i = 0; i < n[0]; ++i)
            if (!(std::abs(row[i + to_next[axis]] - row[i]) < least)) return false;
        }
  }
  return true;
}

bool is_rigid_by_faces(const Body& body) {
  if (body.part || !has_all_springs(body)) return false;
  cases::Grid grid;
  grid.cells = body.cells;
  for_each_place(body.cells,
                 [&](int i, int j, int k) { grid.present.push_back(!body.cell(i, j, k).is_empty()); });
  const cases::Pieces pieces = cases::pieces_of(grid);
  std::vector<bool> is_constrained(index(3 * body.layout.size));
  for (const std::ptrdiff_t entry : body.constrained) is_constrained[index(entry)] = true;
  std::vector<Held> held(pieces.sizes.size());
  std::size_t cell = 0;
  for_each_place(body.cells, [&](int i, int j, int k) {
    const int piece_of_cell = pieces.piece_of_cell[cell++];
    if (piece_of_cell < 0) return;
    Held& of_piece = held[index(piece_of_cell)];
    for (int v = 0; v < 8 && of_piece.n < 3; ++v) {
      const Eigen::Vector3i node(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
      bool is_held = true;
      for (int c = 0; c < 3; ++c)
        is_held = is_held && is_constrained[index(body.layout.at(node[0], node[1], node[2], c))];
      if (is_held) of_piece.add(node);
    }
  });
  return std::all_of(held.begin(), held.end(), [](const Held& of_piece) { return of_piece.n == 3; });
}

} // namespace springproof::msm::grid
