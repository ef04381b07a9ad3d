#include "cases/mesh/find_grid.hpp"

#include <cmath>
#include <map>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr double tolerance = 1e-8; ///< of the spacing

/// A position in steps of a spacing, if it is a whole number of them in each direction.
std::optional<std::array<int, 3>> steps(const Vector3d& from_origin, const Vector3d& spacing) {
  std::array<int, 3> whole{};
  for (int a = 0; a < 3; ++a) {
    const double ratio = from_origin[a] / spacing[a];
    const double nearest = std::round(ratio);
    if (!(std::abs(ratio - nearest) <= tolerance * std::max(1.0, nearest)) || !(nearest < 1e6))
      return std::nullopt;
    whole[static_cast<std::size_t>(a)] = static_cast<int>(nearest);
  }
  return whole;
}

struct Bounds {
  Vector3d lower, upper;
};

template<class Points>
Bounds bounding_box(const Points& points) {
  Bounds box{points[0], points[0]};
  for (const Vector3d& point : points) {
    box.lower = box.lower.cwiseMin(point);
    box.upper = box.upper.cwiseMax(point);
  }
  return box;
}

/// The cell with its vertices in the order i + 2j + 4k along the axes, if it is a cuboid of that spacing.
std::optional<std::array<int, 8>> along_axes(const HexMesh& mesh, std::size_t cell, const Vector3d& spacing) {
  const auto vertices = cell_vertices(mesh, cell);
  const Vector3d lower = bounding_box(vertices).lower;
  std::array<int, 8> ordered;
  ordered.fill(-1);
  for (std::size_t v = 0; v < 8; ++v) {
    const auto corner = steps(vertices[v] - lower, spacing);
    if (!corner) return std::nullopt;
    const auto [i, j, k] = *corner;
    if (i > 1 || j > 1 || k > 1) return std::nullopt;
    ordered[static_cast<std::size_t>(i + 2 * j + 4 * k)] = mesh.cells[cell][v];
  }
  for (const int node : ordered)
    if (node < 0) return std::nullopt;
  return ordered;
}

} // namespace

bool find_grid(HexMesh& mesh) {
  const Bounds body = bounding_box(mesh.nodes), first = bounding_box(cell_vertices(mesh, 0));
  Grid grid;
  grid.origin = body.lower;
  grid.spacing = first.upper - first.lower;
  if (!((grid.spacing.array() > 0).all())) return false;
  const auto extent = steps(body.upper - body.lower, grid.spacing);
  if (!extent) return false;
  grid.cells = *extent;

  std::map<std::size_t, std::pair<std::array<int, 8>, std::size_t>> by_place; // x runs fastest
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const auto cell = along_axes(mesh, c, grid.spacing);
    if (!cell) return false;
    const auto place = steps(mesh.nodes[static_cast<std::size_t>((*cell)[0])] - grid.origin, grid.spacing);
    if (!place) return false;
    const auto [i, j, k] = *place;
    const std::size_t row =
        static_cast<std::size_t>(j) + static_cast<std::size_t>(grid.cells[1]) * static_cast<std::size_t>(k);
    const std::size_t number = static_cast<std::size_t>(i) + static_cast<std::size_t>(grid.cells[0]) * row;
    if (!by_place.emplace(number, std::pair(*cell, c)).second) return false;
  }
  // The spacing of the first cell carries its rounding; that of the whole body less.
  grid.spacing =
      (body.upper - body.lower).cwiseQuotient(Vector3d(grid.cells[0], grid.cells[1], grid.cells[2]));

  if (mesh.cells.size() < grid.n_lattice_cells()) grid.present.assign(grid.n_lattice_cells(), false);
  const std::vector<std::string> groups = mesh.group_of_cell;
  std::size_t c = 0;
  for (const auto& [number, cell] : by_place) {
    if (!grid.present.empty()) grid.present[number] = true;
    mesh.cells[c] = cell.first;
    if (!groups.empty()) mesh.group_of_cell[c] = groups[cell.second];
    ++c;
  }
  mesh.grid = grid;
  return true;
}

} // namespace springproof::cases
