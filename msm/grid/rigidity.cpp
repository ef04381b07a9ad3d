#include "msm/grid/rigidity.hpp"

#include "cases/mesh/hex_mesh.hpp"

#include <Eigen/Geometry>
#include <numeric>
#include <unordered_map>

namespace springproof::msm::grid {

namespace {

using cases::index;

/// Sets of cells that are one piece (Tarjan 1975).
class Pieces {
 public:
  explicit Pieces(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t of(std::size_t cell) {
    while (parent_[cell] != cell) cell = parent_[cell] = parent_[parent_[cell]];
    return cell;
  }
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<std::size_t> parent_;
};

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
  const auto number = [&](int i, int j, int k) {
    return index(i + body.cells[0] * (j + std::ptrdiff_t{body.cells[1]} * k));
  };
  const auto has = [&](int i, int j, int k) { return !body.cell(i, j, k).is_empty(); };
  Pieces pieces(index(body.cells[0]) * index(body.cells[1]) * index(body.cells[2]));
  std::vector<bool> is_constrained(index(3 * body.layout.size));
  for (const std::ptrdiff_t entry : body.constrained) is_constrained[index(entry)] = true;
  for_each_place(body.cells, [&](int i, int j, int k) {
    if (!has(i, j, k)) return;
    if (has(i - 1, j, k)) pieces.join(number(i, j, k), number(i - 1, j, k));
    if (has(i, j - 1, k)) pieces.join(number(i, j, k), number(i, j - 1, k));
    if (has(i, j, k - 1)) pieces.join(number(i, j, k), number(i, j, k - 1));
  });
  std::unordered_map<std::size_t, Held> held; // of every piece
  for_each_place(body.cells, [&](int i, int j, int k) {
    if (!has(i, j, k)) return;
    Held& of_piece = held[pieces.of(number(i, j, k))];
    for (int v = 0; v < 8 && of_piece.n < 3; ++v) {
      const Eigen::Vector3i node(i + (v & 1), j + ((v >> 1) & 1), k + (v >> 2));
      bool is_held = true;
      for (int c = 0; c < 3; ++c)
        is_held = is_held && is_constrained[index(body.layout.at(node[0], node[1], node[2], c))];
      if (is_held) of_piece.add(node);
    }
  });
  return std::all_of(held.begin(), held.end(), [](const auto& of_piece) { return of_piece.second.n == 3; });
}

} // namespace springproof::msm::grid
