#include "cases/mesh/pieces.hpp"

namespace springproof::cases {

Pieces pieces_of(const Grid& grid) {
  Pieces pieces;
  pieces.piece_of_cell.assign(grid.present.size(), -1);
  std::vector<std::size_t> to_visit;
  const auto visit = [&](std::size_t cell) {
    if (!grid.present[cell] || pieces.piece_of_cell[cell] >= 0) return;
    pieces.piece_of_cell[cell] = static_cast<int>(pieces.sizes.size()) - 1;
    to_visit.push_back(cell);
  };
  for (std::size_t first = 0; first < grid.present.size(); ++first) {
    if (!grid.present[first] || pieces.piece_of_cell[first] >= 0) continue;
    pieces.sizes.push_back(0);
    for (visit(first); !to_visit.empty(); ++pieces.sizes.back()) {
      const std::size_t cell = to_visit.back();
      to_visit.pop_back();
      std::size_t stride = 1;
      for (const int n_cells : grid.cells) {
        const std::size_t n = index(n_cells), place = cell / stride % n;
        if (place > 0) visit(cell - stride);
        if (place + 1 < n) visit(cell + stride);
        stride *= n;
      }
    }
  }
  return pieces;
}

} // namespace springproof::cases
