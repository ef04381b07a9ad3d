#include "cases/mesh/voxels.hpp"

#include "cases/mesh/mesh.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

Eigen::AlignedBox3d box_of(const Surface& surface) {
  Eigen::AlignedBox3d body;
  for (const auto& triangle : surface) body.extend(bounding_box(triangle));
  return body;
}

/// Reads the body's surface, at its scale.
Surface scaled_surface(const Voxels& voxels, std::vector<std::string>* remarks = nullptr) {
  Surface surface = read_body_surface(voxels.file, remarks);
  for (auto& triangle : surface)
    for (Vector3d& vertex : triangle) vertex *= voxels.scale;
  return surface;
}

Grid empty_grid(const Surface& surface, const Voxels& voxels) {
  const Eigen::AlignedBox3d body = box_of(surface);
  Grid grid;
  grid.origin = body.min();
  grid.spacing.setConstant(voxels.edge);
  double n_cells = 1;
  for (int a = 0; a < 3; ++a) {
    // A body of exactly n edges has n cells, whatever the rounding of its coordinates to single precision.
    const double rounding =
        std::numeric_limits<float>::epsilon() * std::max(std::abs(body.min()[a]), std::abs(body.max()[a]));
    const double n = std::max(1.0, std::ceil((body.sizes()[a] - rounding) / voxels.edge - 1e-6));
    n_cells *= n;
    if (!(n_cells <= Grid::most_cells))
      voxels.file.refuse(fmt::format("needs more than {:.0e} cells of edge {} mm: {}", Grid::most_cells,
                                     voxels.edge, scale_hint(body.sizes())));
    grid.cells[index(a)] = static_cast<int>(n);
  }
  grid.present.assign(grid.n_lattice_cells(), false);
  return grid;
}

/// Where the vertical through a point meets a triangle, and from which side: +1 leaving the body going up, -1
/// entering.
struct Crossing {
  double z;
  int side;
  bool operator<(const Crossing& other) const { return z < other.z; }
};

/// Twice the signed area of a triangle seen from above.
double doubled_area(const Vector3d& a, const Vector3d& b, double x, double y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

/// Adds the crossings of a triangle to the columns of centres below and above its shadow.
void cast(const std::array<Vector3d, 3>& t, const Grid& grid, const Vector3d& first,
          std::vector<std::vector<Crossing>>& columns) {
  std::array<int, 2> from, to;
  for (std::size_t a = 0; a < 2; ++a) {
    const auto place = [&](std::size_t v) { return (t[v][int(a)] - first[int(a)]) / grid.spacing[int(a)]; };
    const auto [low, high] = std::minmax({place(0), place(1), place(2)});
    from[a] = std::max(0, static_cast<int>(std::ceil(low)));
    to[a] = std::min(grid.cells[a] - 1, static_cast<int>(std::floor(high)));
  }
  for (int j = from[1]; j <= to[1]; ++j)
    for (int i = from[0]; i <= to[0]; ++i) {
      const double x = first.x() + i * grid.spacing.x(), y = first.y() + j * grid.spacing.y();
      const double a = doubled_area(t[1], t[2], x, y), b = doubled_area(t[2], t[0], x, y),
                   c = doubled_area(t[0], t[1], x, y);
      const bool is_inside = (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
      if (!is_inside) continue;
      const double z = (a * t[0].z() + b * t[1].z() + c * t[2].z()) / (a + b + c);
      columns[index(i) + index(grid.cells[0]) * index(j)].push_back({z, a > 0 ? 1 : -1});
    }
}

/// Marks the cells whose centre has a winding number other than 0. VTK's stencil of a surface has the same
/// cells where parts do not overlap; where they do, it counts crossings and leaves a hole.
void fill(Grid& grid, const Surface& surface) {
  const double edge = grid.spacing.x();
  // A ray along the common edge of two triangles would miss both. Edges of drawn bodies pass through cells'
  // centres, but hardly through these points beside them.
  const Vector3d first = grid.origin + edge * Vector3d(0.5 + 1.37e-7, 0.5 + 2.71e-7, 0.5);
  std::vector<std::vector<Crossing>> columns(index(grid.cells[0]) * index(grid.cells[1]));
  for (const auto& triangle : surface) cast(triangle, grid, first, columns);
  for (std::size_t column = 0; column < columns.size(); ++column) {
    std::sort(columns[column].begin(), columns[column].end());
    int winding = 0;
    auto next = columns[column].begin();
    for (int k = 0; k < grid.cells[2]; ++k) {
      for (; next != columns[column].end() && next->z <= first.z() + k * edge; ++next) winding -= next->side;
      if (winding != 0) grid.present[column + columns.size() * index(k)] = true;
    }
  }
}

} // namespace

Surface read_body_surface(const NamedFile& file, std::vector<std::string>* remarks) {
  try {
    return read_triangles(file.path, remarks);
  } catch (const std::exception& error) {
    file.refuse_once(error.what());
  }
}

std::size_t n_open_edges(const TriangleMesh& surface) {
  std::map<std::array<int, 2>, long> balance; // edges between two vertices: one way minus the other way
  for (const auto& triangle : surface.triangles)
    for (std::size_t v = 0; v < 3; ++v) {
      const int a = triangle[v], b = triangle[(v + 1) % 3];
      balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  std::size_t open = 0;
  for (const auto& [edge, difference] : balance) open += static_cast<std::size_t>(std::abs(difference));
  return open;
}

std::string several_pieces(std::vector<std::size_t> sizes, double edge) {
  std::sort(sizes.rbegin(), sizes.rend());
  return fmt::format(
      "cells of edge {} mm fall into {} pieces that share no face, the largest of {} cells and "
      "the next of {}: ",
      edge, sizes.size(), sizes.at(0), sizes.at(1));
}

VoxelCounts count_voxels(const Voxels& voxels) {
  const Surface surface = scaled_surface(voxels);
  double volume = 0; // sum over the tetrahedra from the origin to the triangles
  for (const auto& [a, b, c] : surface) volume += a.dot(b.cross(c)) / 6;
  const Eigen::AlignedBox3d body = box_of(surface);
  VoxelCounts counts{std::abs(volume) / (voxels.edge * voxels.edge * voxels.edge), {}};
  for (int a = 0; a < 3; ++a)
    counts.of_grid[index(a)] = static_cast<int>(std::clamp(body.sizes()[a] / voxels.edge, 1., 1e6));
  return counts;
}

Mesh make_voxel_mesh(const Voxels& voxels, std::vector<std::string>* remarks) {
  return make_voxel_mesh(scaled_surface(voxels, remarks), voxels);
}

Mesh make_voxel_mesh(const Surface& surface, const Voxels& voxels) {
  const auto refuse = [&](const std::string& reason) { voxels.file.refuse(reason); };
  if (const std::size_t open = n_open_edges(joined(surface)))
    refuse(fmt::format("is not closed: {} edges of its {} triangles have no neighbour running the other way",
                       open, surface.size()));
  Grid grid = empty_grid(surface, voxels);
  fill(grid, surface);
  const std::vector<std::size_t> sizes = pieces_of(grid).sizes;
  if (sizes.empty())
    refuse(fmt::format("no cell of edge {} mm has its centre inside: {}", voxels.edge,
                       scale_hint(box_of(surface).sizes())));
  if (sizes.size() > 1) refuse(several_pieces(sizes, voxels.edge) + "a smaller edge joins what is thin");
  return make_grid_mesh(grid);
}

} // namespace springproof::cases
