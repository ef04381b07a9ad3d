#include "cases/scene/thickness.hpp"

#include "cases/scene/regions.hpp"

#include <tuple>

namespace springproof::cases {

namespace {

/// The cells beside each cell's faces, in the order of cell_faces; -1 where there is none.
using Neighbours = std::vector<std::array<int, 6>>;

Neighbours neighbours_in_grid(const Grid& grid) {
  const std::array<int, 3> strides{1, grid.cells[0], grid.cells[0] * grid.cells[1]};
  const int n_places = static_cast<int>(grid.n_lattice_cells());
  std::vector<int> number(index(n_places), -1);
  int n_cells = 0;
  for (int place = 0; place < n_places; ++place)
    if (grid.present.empty() || grid.present[index(place)]) number[index(place)] = n_cells++;
  Neighbours neighbours;
  for (int place = 0; place < n_places; ++place) {
    if (number[index(place)] < 0) continue;
    auto& own = neighbours.emplace_back();
    for (std::size_t a = 0; a < 3; ++a) {
      const int at = place / strides[a] % grid.cells[a];
      own[2 * a] = at > 0 ? number[index(place - strides[a])] : -1;
      own[2 * a + 1] = at + 1 < grid.cells[a] ? number[index(place + strides[a])] : -1;
    }
  }
  return neighbours;
}

Neighbours neighbours_of(const Mesh& mesh) {
  if (mesh.grid) return neighbours_in_grid(*mesh.grid);
  std::vector<std::tuple<std::array<int, 4>, int, std::size_t>> faces;
  faces.reserve(6 * mesh.cells.size());
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (std::size_t f = 0; f < 6; ++f)
      faces.emplace_back(sorted(pick(mesh.cells[c], cell_faces[f])), static_cast<int>(c), f);
  std::sort(faces.begin(), faces.end());
  Neighbours neighbours(mesh.cells.size(), {-1, -1, -1, -1, -1, -1});
  for (std::size_t n = 1; n < faces.size(); ++n) {
    const auto& [nodes, cell, face] = faces[n - 1];
    const auto& [same_nodes, other, other_face] = faces[n];
    if (nodes != same_nodes) continue;
    neighbours[index(cell)][face] = other;
    neighbours[index(other)][other_face] = cell;
  }
  return neighbours;
}

} // namespace

std::vector<int> cells_across(const Mesh& mesh, const std::vector<Fixed>& symmetry, int most) {
  const Neighbours neighbours = neighbours_of(mesh);
  const std::vector<int> planes = planes_of_nodes(mesh, symmetry);
  const auto is_mirror = [&](int cell, std::size_t face) {
    int common = planes.empty() ? 0 : ~0;
    if (common != 0)
      for (const int node : pick(mesh.cells[index(cell)], cell_faces[face])) common &= planes[index(node)];
    return common != 0;
  };
  std::vector<int> across(mesh.cells.size(), most);
  std::vector<int> row;
  for (int first = 0; first < static_cast<int>(across.size()); ++first)
    for (std::size_t start = 0; start < 6; ++start) {
      if (neighbours[index(first)][start] >= 0) continue; // a row begins at the surface
      row = {first};
      std::size_t face = start ^ 1U; // the one that the row goes on through
      for (int next = neighbours[index(first)][face]; next >= 0; next = neighbours[index(next)][face]) {
        const auto& beside = neighbours[index(next)];
        std::size_t entry = 0;
        while (entry < 5 && beside[entry] != row.back()) ++entry;
        face = entry ^ 1U;
        row.push_back(next);
      }
      const int n_mirrors = (is_mirror(first, start) ? 1 : 0) + (is_mirror(row.back(), face) ? 1 : 0);
      const int n = n_mirrors == 2 ? most : (1 + n_mirrors) * static_cast<int>(row.size());
      for (const int cell : row) across[index(cell)] = std::min(across[index(cell)], n);
    }
  return across;
}

} // namespace springproof::cases
