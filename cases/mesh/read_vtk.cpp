#include "cases/mesh/read_vtk.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/vtk.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

namespace cereal {

SPRINGPROOF_FIELDS(springproof::cases::PointField, name, values, unit)
SPRINGPROOF_FIELDS(springproof::cases::PointCloud, points, is_single_precision, fields, others)
SPRINGPROOF_FIELDS(springproof::cases::Interpolation, first, points, weights, outside)
SPRINGPROOF_FIELDS(springproof::cases::CellCloud, cloud, to_nodes, from_nodes)

} // namespace cereal

namespace springproof::cases {

namespace {

void check(const PointCloud& cloud) {
  for (const PointField& field : cloud.fields)
    if (field.values.size() != cloud.points.size())
      throw std::runtime_error("'" + field.name + "' has not as many values as there are points");
}

void check(const Interpolation& interpolation, std::size_t n_points, std::size_t n_positions) {
  const auto& [first, points, weights, outside] = interpolation;
  const bool is_sound =
      outside.size() == n_positions && first.size() == n_positions + 1 && first.front() == 0 &&
      std::is_sorted(first.begin(), first.end()) && first.back() == points.size() &&
      points.size() == weights.size() &&
      std::all_of(points.begin(), points.end(), [&](int p) { return p >= 0 && index(p) < n_points; }) &&
      std::all_of(weights.begin(), weights.end(), [](double weight) { return std::isfinite(weight); }) &&
      std::all_of(outside.begin(), outside.end(),
                  [](double distance) { return std::isfinite(distance) && distance >= 0; });
  if (!is_sound) throw std::runtime_error("has cells that do not interpolate");
}

} // namespace

Surface read_triangles(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw std::runtime_error(path + ": " + error.message());
  return surface_from(
      run_confined([&] { return bytes_of(vtk().read_triangles(path)); }, limits_to_read(size)));
}

PointCloud read_point_cloud(const std::string& content) {
  return point_cloud_from(
      run_confined([&] { return bytes_of(vtk().read_points(content)); }, limits_to_read(content.size())));
}

CellCloud read_cell_cloud(const std::string& content, const HexMesh& mesh) {
  constexpr std::uint64_t per_node = 100; // bytes of a file with as much work
  return cell_cloud_from(run_confined([&] { return bytes_of(vtk().read_cells(content, mesh)); },
                                      limits_to_read(content.size() + per_node * mesh.nodes.size())),
                         mesh.nodes.size());
}

Surface surface_from(const std::string& bytes) {
  Surface surface;
  from_bytes(bytes, surface);
  if (surface.empty()) throw std::runtime_error("has no triangles");
  for (const auto& triangle : surface)
    for (const Eigen::Vector3d& vertex : triangle)
      if (!vertex.allFinite()) throw std::runtime_error("has a position that is not finite");
  return surface;
}

PointCloud point_cloud_from(const std::string& bytes) {
  PointCloud cloud;
  from_bytes(bytes, cloud);
  check(cloud);
  return cloud;
}

CellCloud cell_cloud_from(const std::string& bytes, std::size_t n_nodes) {
  CellCloud cloud;
  from_bytes(bytes, cloud);
  check(cloud.cloud);
  check(cloud.to_nodes, cloud.cloud.points.size(), n_nodes);
  check(cloud.from_nodes, n_nodes, cloud.cloud.points.size());
  return cloud;
}

std::string bytes_of(const Surface& surface) {
  return to_bytes(surface);
}

std::string bytes_of(const PointCloud& cloud) {
  return to_bytes(cloud);
}

std::string bytes_of(const CellCloud& cloud) {
  return to_bytes(cloud);
}

} // namespace springproof::cases
