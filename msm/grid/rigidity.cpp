#include "msm/grid/rigidity.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/Geometry>

namespace springproof::msm::grid {

namespace {

using cases::index;

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
