#include "cases/mesh/vtk_functions.hpp"

#include "cases/case/error.hpp"
#include "cases/case/installation.hpp"
#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
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

/// Corners from the lowest one on, in their sense: the same of the same triangle.
using Corners = std::array<std::array<double, 3>, 3>;
Corners corners_of(const std::array<Eigen::Vector3d, 3>& triangle) {
  Corners corners;
  for (std::size_t v = 0; v < 3; ++v)
    for (int a = 0; a < 3; ++a) corners[v][index(a)] = triangle[v][a] + 0.0; // -0 is 0
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

/// Leaves every triangle once.  @return number of those removed
std::size_t leave_once(Surface& surface) {
  std::set<Corners> seen;
  const auto is_known = [&](const auto& triangle) { return !seen.insert(corners_of(triangle)).second; };
  const auto end = std::remove_if(surface.begin(), surface.end(), is_known);
  const auto n = static_cast<std::size_t>(surface.end() - end);
  surface.erase(end, surface.end());
  return n;
}

TriangleMesh with_triangles(const Surface& surface) {
  TriangleMesh mesh = joined(surface);
  if (mesh.triangles.empty()) throw std::runtime_error("has no triangle with three different corners");
  return mesh;
}

} // namespace

void check_has_vtk() {
  std::error_code none;
  if (!std::filesystem::exists(private_file("springproof_vtk.so"), none))
    throw InputError(
        "this build has no VTK (.vtu, .vtp and .stl files, pictures, surfaces in meshes): type ./do "
        "packages, then ./do build");
}

const VtkFunctions& vtk() {
  static const auto* const functions = [] {
    check_has_vtk();
    return static_cast<const VtkFunctions*>(load_shared_object("springproof_vtk"));
  }();
  return *functions;
}

Surface read_triangles(const std::string& path, std::vector<std::string>* remarks) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw std::runtime_error(path + ": " + error.message());
  if (!std::ifstream(path)) throw std::runtime_error(path + ": cannot be read");
  const VtkFunctions& functions = vtk(); // loaded before the child is confined
  Surface surface = surface_from(
      run_confined([&] { return bytes_of(functions.read_triangles(path)); }, limits_to_read(size)));
  std::uint32_t stated = 0; // by a binary STL; the same bytes of a text are a number far larger
  if (std::filesystem::path(path).extension() == ".stl")
    std::ifstream(path, std::ios::binary).seekg(80).read(reinterpret_cast<char*>(&stated), sizeof stated);
  const std::uintmax_t end = 84 + 50 * std::uintmax_t{stated};
  const auto remark = [&](std::uintmax_t n, const char* what) {
    if (remarks && n > 0) remarks->push_back(path + ": " + std::to_string(n) + what);
  };
  remark(stated == surface.size() && size > end ? size - end : 0,
         " bytes after the last triangle are left out");
  remark(leave_once(surface), " triangles that are there before are left out");
  remark(index(std::count_if(surface.begin(), surface.end(), has_no_area)),
         " triangles without an area bound nothing");
  return surface;
}

PointCloud read_point_cloud(const std::string& content) {
  return point_cloud_from(
      run_confined([&] { return bytes_of(vtk().read_points(content)); }, limits_to_read(content.size())));
}

CellCloud read_cell_cloud(const std::string& content, const Mesh& mesh) {
  constexpr std::uint64_t per_node = 100; // bytes of a file with as much work
  return cell_cloud_from(run_confined([&] { return bytes_of(vtk().read_cells(content, mesh)); },
                                      limits_to_read(content.size() + per_node * mesh.nodes.size())),
                         mesh.nodes.size());
}

TriangleMesh read_surface(const std::string& path, std::vector<std::string>* remarks) {
  return with_triangles(read_triangles(path, remarks));
}

TriangleMesh contour(const Picture& picture, const ContourSettings& settings) {
  double n_values = 1;
  for (const int n : picture.n_points) n_values *= n;
  if (!(std::all_of(picture.n_points.begin(), picture.n_points.end(), [](int n) { return n > 0; }) &&
        n_values == static_cast<double>(picture.values.size())))
    throw std::runtime_error("a picture has not as many values as points");
  constexpr std::uint64_t per_value = 4; // bytes of a file with as much work
  return with_triangles(surface_from(run_confined([&] { return bytes_of(vtk().contour(picture, settings)); },
                                                  limits_to_read(per_value * picture.values.size()))));
}

TriangleMesh decimated(const TriangleMesh& surface, std::size_t n_triangles) {
  constexpr std::uint64_t per_triangle = 50; // bytes of a file with as much work
  Limits limits = limits_to_read(per_triangle * surface.triangles.size());
  limits.seconds = 20;
  const auto& functions = vtk(); // loaded before the child is confined
  return with_triangles(surface_from(
      run_confined([&] { return bytes_of(functions.decimated(surface, n_triangles)); }, limits)));
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
