#include "cases/mesh/labels.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/mesh.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <tuple>

namespace cereal {

SPRINGPROOF_FIELDS(springproof::cases::LabelGrid, cells, origin, class_of_cell, lowest, highest, size)
SPRINGPROOF_FIELDS(springproof::cases::Placement, axes, corner, is_by_sform, code)

} // namespace cereal

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

[[noreturn]] void refuse_labels(const std::string& reason) {
  throw std::runtime_error(reason);
}

/// A voxel that overlaps a cell along an axis, and the part of the cell's edge that it covers.
struct Overlap {
  int voxel;
  double part;
};

/// The voxels of every cell along one axis. Both ends of a voxel are cut off at those of the crop.
std::vector<std::vector<Overlap>> overlaps(int n_cells, double origin, double edge, int n_voxels,
                                           double spacing) {
  std::vector<std::vector<Overlap>> of_cell(index(n_cells));
  for (int c = 0; c < n_cells; ++c) {
    const double from = origin + c * edge, to = from + edge;
    const int first = std::max(0, static_cast<int>(std::floor(from / spacing)) - 1);
    for (int v = first; v < n_voxels && v * spacing < to; ++v) {
      const double part = (std::min(to, (v + 1) * spacing) - std::max(from, v * spacing)) / edge;
      if (part > 0) of_cell[index(c)].push_back({v, part});
    }
  }
  return of_cell;
}

/// Returns for every voxel one more than the place of the first class that has its intensity; 0: none.
std::vector<std::uint8_t> class_of_voxels(const Volume& volume, const Labels& labels) {
  std::vector<std::uint8_t> classes(volume.intensities.size(), 0);
  for (std::size_t v = 0; v < classes.size(); ++v)
    for (std::size_t c = labels.classes.size(); c-- > 0;) // the first one is set last
      // Intensities are rounded to single precision, so their bounds are.
      if (volume.intensities[v] >= static_cast<float>(labels.classes[c].lower) &&
          volume.intensities[v] <= static_cast<float>(labels.classes[c].upper))
        classes[v] = static_cast<std::uint8_t>(c + 1);
  return classes;
}

/// Lowest and highest intensity that are numbers; 0 and 0 where none is.
std::pair<float, float> range_of(const Volume& volume) {
  std::optional<std::pair<float, float>> range;
  for (const float intensity : volume.intensities) {
    if (!std::isfinite(intensity)) continue;
    if (!range) range = {intensity, intensity};
    range->first = std::min(range->first, intensity);
    range->second = std::max(range->second, intensity);
  }
  return range.value_or(std::pair(0.F, 0.F));
}

/// Text about the intensities, in which a wrong order of bytes shows.
std::string intensities_text(const LabelGrid& grid) {
  return fmt::format("the picture's intensities are from {:.6g} to {:.6g}", grid.lowest, grid.highest);
}

LabelGrid empty_label_grid(const Volume& volume, const Labels& labels) {
  const Vector3d size =
      volume.spacing.cwiseProduct(Vector3d(volume.voxels[0], volume.voxels[1], volume.voxels[2]));
  const Vector3d from = labels.crop ? labels.crop->at(0) : Vector3d::Zero();
  const Vector3d to = labels.crop ? labels.crop->at(1) : size;
  LabelGrid grid;
  grid.origin = from;
  grid.size = size;
  double n_cells = 1;
  for (int a = 0; a < 3; ++a) {
    const double n = std::max(1.0, std::ceil((to[a] - from[a]) / labels.edge - 1e-6));
    n_cells *= n;
    if (!(n_cells <= Grid::most_cells))
      refuse_labels(fmt::format("{:.6g} x {:.6g} x {:.6g} mm need more than {:.0e} cells of edge {} mm: {}",
                                to[0] - from[0], to[1] - from[1], to[2] - from[2], Grid::most_cells,
                                labels.edge, scale_hint(size)));
    grid.cells[index(a)] = static_cast<int>(n);
  }
  grid.class_of_cell.assign(static_cast<std::size_t>(n_cells), 0);
  return grid;
}

Grid grid_of(const LabelGrid& labelled, double edge) {
  Grid grid;
  grid.cells = labelled.cells;
  grid.spacing.setConstant(edge);
  grid.origin = labelled.origin;
  for (const std::uint8_t c : labelled.class_of_cell) grid.present.push_back(c != 0);
  return grid;
}

/// The place in the grid of the cell at a point, if there is one.
std::optional<std::size_t> place_at(const LabelGrid& grid, double edge, const Vector3d& point) {
  std::size_t place = 0;
  for (int a = 2; a >= 0; --a) {
    const double along = std::floor((point[a] - grid.origin[a]) / edge);
    if (!(along >= 0 && along < grid.cells[index(a)])) return std::nullopt;
    place = place * index(grid.cells[index(a)]) + static_cast<std::size_t>(along);
  }
  return place;
}

/// Whether each cell of a grid, or one that shares a node with it, belongs to a class.
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

/// Voxels along one axis whose centre lies in the grid, and the cells of these centres.
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

/// @throws std::runtime_error if it is no regular file
VolumeBytes bytes_of_volume(const std::string& path) {
  constexpr int first_of_gzip = 0x1f;
  std::error_code absent;
  if (!std::filesystem::is_regular_file(path, absent))
    throw std::runtime_error(absent ? absent.message() : "is no regular file");
  const std::uint64_t bytes = std::filesystem::file_size(path), most_compressed = 1040;
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".nii") return {bytes, bytes, false};
  const bool is_plain_tar =
      ending == ".inv3" && std::ifstream(path, std::ios::binary).peek() != first_of_gzip;
  return {bytes, most_compressed * bytes, !is_plain_tar};
}

/// Reads the picture of a body, at the body's scale.
Volume read_scaled_volume(const Labels& labels, const VolumeBytes& bytes) {
  Volume volume = vtk().read_volume(labels.file.path, bytes);
  volume.spacing *= labels.scale;
  return volume;
}

} // namespace

LabelGrid label_cells(const Volume& volume, const Labels& labels) {
  LabelGrid grid = empty_label_grid(volume, labels);
  const std::vector<std::uint8_t> classes = class_of_voxels(volume, labels);
  std::array<std::vector<std::vector<Overlap>>, 3> along;
  for (std::size_t a = 0; a < 3; ++a)
    along[a] = overlaps(grid.cells[a], grid.origin[static_cast<int>(a)], labels.edge, volume.voxels[a],
                        volume.spacing[static_cast<int>(a)]);
  std::tie(grid.lowest, grid.highest) = range_of(volume);
  std::vector<double> filled(labels.classes.size() + 1);
  std::size_t cell = 0;
  for (const auto& in_z : along[2])
    for (const auto& in_y : along[1])
      for (const auto& in_x : along[0]) {
        std::fill(filled.begin(), filled.end(), 0.);
        for (const Overlap& z : in_z)
          for (const Overlap& y : in_y)
            for (const Overlap& x : in_x)
              filled[classes[index(x.voxel) +
                             index(volume.voxels[0]) *
                                 (index(y.voxel) + index(volume.voxels[1]) * index(z.voxel))]] +=
                  x.part * y.part * z.part;
        filled[0] = 1;
        for (std::size_t c = 1; c < filled.size(); ++c) filled[0] -= filled[c];
        std::size_t most = 0;
        constexpr double rounding = 1e-9; // error in sums of parts
        for (std::size_t c = filled.size(); c-- > 1;)
          if (filled[c] >= filled[most] - rounding) most = c;
        grid.class_of_cell[cell++] = static_cast<std::uint8_t>(most);
      }
  return grid;
}

void keep_piece(LabelGrid& grid, const Labels& labels) {
  const Pieces pieces = pieces_of(grid_of(grid, labels.edge));
  const auto& sizes = pieces.sizes;
  if (sizes.empty())
    refuse_labels(fmt::format("no cell of edge {} mm is filled by a class for the most part; {}; {}",
                              labels.edge, intensities_text(grid), scale_hint(grid.size)));
  int kept = 0;
  if (labels.keep == Keep::all) {
    if (sizes.size() == 1) return;
    refuse_labels(several_pieces(sizes, labels.edge) +
                  "keep = \"largest\" or a point in one of them leaves one");
  }
  if (labels.keep == Keep::seed) {
    const auto place = place_at(grid, labels.edge, labels.seed);
    kept = place ? pieces.piece_of_cell[*place] : -1;
    if (kept < 0)
      refuse_labels(fmt::format("keep = [{}] is in no cell of a class", fmt::join(labels.seed, ", ")));
  } else {
    kept = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  }
  for (std::size_t c = 0; c < grid.class_of_cell.size(); ++c)
    if (pieces.piece_of_cell[c] != kept) grid.class_of_cell[c] = 0;
}

Mesh mesh_of(const LabelGrid& labelled, const Labels& labels) {
  Mesh mesh = make_grid_mesh(cropped(grid_of(labelled, labels.edge)));
  std::vector<std::size_t> n_cells(labels.classes.size(), 0);
  mesh.group_of_cell.reserve(mesh.cells.size());
  for (const std::uint8_t c : labelled.class_of_cell) {
    if (c == 0) continue;
    mesh.group_of_cell.push_back(labels.classes[c - 1u].name);
    ++n_cells[c - 1u];
  }
  for (std::size_t c = 0; c < n_cells.size(); ++c)
    if (n_cells[c] == 0)
      refuse_labels(fmt::format("class '{}', from {} to {}, has no cell of edge {} mm; {}",
                                labels.classes[c].name, labels.classes[c].lower, labels.classes[c].upper,
                                labels.edge, intensities_text(labelled)));
  return mesh;
}

LabelGrid label_grid_from(const std::string& bytes, std::size_t n_classes) {
  LabelGrid grid;
  from_bytes(bytes, grid);
  double n = 1;
  for (const int cells : grid.cells) n *= cells > 0 ? cells : 0;
  const bool is_sound = n > 0 && n == static_cast<double>(grid.class_of_cell.size()) &&
                        grid.origin.allFinite() && grid.size.allFinite() && std::isfinite(grid.lowest) &&
                        std::isfinite(grid.highest) &&
                        std::all_of(grid.class_of_cell.begin(), grid.class_of_cell.end(),
                                    [&](std::uint8_t c) { return c <= n_classes; });
  if (!is_sound) refuse_labels("is no sound grid of classes");
  return grid;
}

std::string bytes_of(const LabelGrid& grid) {
  return to_bytes(grid);
}

LabelGrid read_label_grid(const Labels& labels) {
  try {
    const VolumeBytes bytes = bytes_of_volume(labels.file.path);
    vtk(); // loaded before the child is confined
    const auto read = [&] { return bytes_of(label_cells(read_scaled_volume(labels, bytes), labels)); };
    LabelGrid grid =
        label_grid_from(run_confined(read, limits_to_read(bytes.in_file)), labels.classes.size());
    keep_piece(grid, labels);
    return grid;
  } catch (const std::exception& error) {
    labels.file.refuse(error.what());
  }
}

Mesh make_label_mesh(const Labels& labels) {
  const LabelGrid grid = read_label_grid(labels);
  try {
    return mesh_of(grid, labels);
  } catch (const std::exception& error) {
    labels.file.refuse(error.what());
  }
}

Placement placement_of(const Labels& labels) {
  try {
    const VolumeBytes bytes = bytes_of_volume(labels.file.path);
    const auto& functions = vtk(); // loaded before the child is confined
    const auto read = [&] { return to_bytes(functions.read_placement(labels.file.path)); };
    Placement placement;
    from_bytes(run_confined(read, limits_to_read(bytes.in_file)), placement);
    Eigen::Matrix3d rotation;
    rotation << placement.axes[0], placement.axes[1], placement.axes[2];
    if (!placement.corner.allFinite() || !rotation.isUnitary(1e-9) || !(rotation.determinant() > 0))
      refuse_labels("has a map to the world that is none");
    placement.corner *= labels.scale;
    return placement;
  } catch (const std::exception& error) {
    labels.file.refuse(error.what());
  }
}

Labels on_grid(const Labels& labels, const Placement& placement) {
  Labels result = labels;
  result.frame = Frame::grid;
  result.seed = placement.to_body(labels.seed);
  if (!labels.crop) return result;
  const Vector3d lower = (*labels.crop)[0], upper = (*labels.crop)[1];
  Eigen::AlignedBox3d cover; // the array may lie askew
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int a) { return (corner >> a & 1) != 0 ? upper[a] : lower[a]; };
    cover.extend(placement.to_body({end(0), end(1), end(2)}));
  }
  result.crop = {cover.min(), cover.max()};
  return result;
}

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
  const VolumeBytes bytes = bytes_of_volume(labels.file.path);
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
  return joined(surface_from(run_confined(make, limits_to_read(bytes.in_file))));
}

} // namespace springproof::cases
