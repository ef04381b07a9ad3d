#include "cases/mesh/label_surface.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/labels.hpp"
#include "cases/mesh/read_vtk.hpp"
#include "cases/mesh/volume_files.hpp"
#include "cases/mesh/vtk.hpp"

#include <fmt/format.h>
#include <stdexcept>

namespace springproof::cases {

namespace {

using Eigen::Vector3d;

/// Of every cell of a grid, whether it or a cell that shares a node with it is of a class.
std::vector<bool> near_body(const LabelGrid& grid) {
  std::vector<bool> near;
  near.reserve(grid.class_of_cell.size());
  for (const std::uint8_t c : grid.class_of_cell) near.push_back(c != 0);
  std::size_t stride = 1;
  for (const int n : grid.cells) { // along one axis after the other: what a cell has, both neighbours get
    const std::vector<bool> before = near;
    for (std::size_t c = 0; c < near.size(); ++c) {
      const std::size_t at = c / stride % index(n);
      near[c] = before[c] || (at > 0 && before[c - stride]) || (at + 1 < index(n) && before[c + stride]);
    }
    stride *= index(n);
  }
  return near;
}

/// Voxels of one axis whose centre lies in the grid, and the cell that it lies in.
struct Centres {
  int first = 0;
  std::vector<std::size_t> cells; ///< one per voxel
};

Centres centres_in_grid(int n_voxels, double spacing, int n_cells, double origin, double edge) {
  Centres centres;
  for (int v = 0; v < n_voxels; ++v) {
    const double cell = std::floor(((v + 0.5) * spacing - origin) / edge);
    if (!(cell >= 0 && cell < n_cells)) continue;
    if (centres.cells.empty()) centres.first = v;
    centres.cells.push_back(static_cast<std::size_t>(cell));
  }
  return centres;
}

} // namespace

Picture picture_about(const Volume& volume, const LabelGrid& grid, double edge, double level) {
  std::array<Centres, 3> along;
  Picture picture{{}, {}, volume.spacing, {}};
  for (int a = 0; a < 3; ++a) {
    along[index(a)] = centres_in_grid(volume.voxels[index(a)], volume.spacing[a], grid.cells[index(a)],
                                      grid.origin[a], edge);
    picture.n_points[index(a)] = static_cast<int>(along[index(a)].cells.size());
    picture.origin[a] = (along[index(a)].first + 0.5) * volume.spacing[a];
  }
  const std::vector<bool> near = near_body(grid);
  const auto& [x, y, z] = along;
  for (std::size_t k = 0; k < z.cells.size(); ++k)
    for (std::size_t j = 0; j < y.cells.size(); ++j)
      for (std::size_t i = 0; i < x.cells.size(); ++i) {
        const std::size_t row = index(y.first) + j + index(volume.voxels[1]) * (index(z.first) + k);
        const float intensity = volume.intensities[index(x.first) + i + index(volume.voxels[0]) * row];
        const std::size_t in_row = y.cells[j] + index(grid.cells[1]) * z.cells[k];
        const bool is_near = near[x.cells[i] + index(grid.cells[0]) * in_row];
        picture.values.push_back(is_near ? intensity
                                         : std::min(intensity, static_cast<float>(2 * level) - intensity));
      }
  return picture;
}

TriangleMesh label_surface(const Labels& labels, const PictureContour& contour) {
  const VolumeBytes bytes = bytes_of_volume(labels.path);
  const auto& functions = vtk(); // loaded before the child is confined
  const auto make = [&] {
    const Volume volume = read_scaled_volume(labels, bytes);
    LabelGrid grid = label_cells(volume, labels);
    keep_piece(grid, labels);
    const Picture picture = picture_about(volume, grid, labels.edge, contour.intensity);
    if (picture.values.empty()) throw std::runtime_error("has no voxel's centre in the cells");
    const Surface surface =
        functions.contour(picture, {contour.intensity, contour.n_smoothing, contour.most_triangles, true});
    if (surface.empty())
      throw std::runtime_error(fmt::format("has no surface at intensity {}", contour.intensity));
    return bytes_of(surface);
  };
  return joined(surface_from(run_confined(make, limits_to_read(bytes.in_files))));
}

} // namespace springproof::cases
