#include "cases/mesh/read_vtk.hpp"

#include "cases/mesh/confined.hpp"
#include "cases/mesh/fields.hpp"
#include "cases/mesh/vtk.hpp"

#include <filesystem>
#include <stdexcept>

namespace cereal {

SPRINGPROOF_FIELDS(springproof::cases::PointField, name, values, unit)
SPRINGPROOF_FIELDS(springproof::cases::PointCloud, points, is_single_precision, fields)

} // namespace cereal

namespace springproof::cases {

Surface read_triangles(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw std::runtime_error(path + ": " + error.message());
  return surface_from(
      run_confined([&] { return bytes_of(vtk().read_triangles(path)); }, limits_to_read(size)));
}

PointCloud read_point_cloud(const std::string& content) {
  return point_cloud_from(run_confined([&] { return bytes_of(vtk().read_unstructured_grid(content)); },
                                       limits_to_read(content.size())));
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
  for (const PointField& field : cloud.fields)
    if (field.values.size() != cloud.points.size())
      throw std::runtime_error("'" + field.name + "' has not as many values as there are points");
  return cloud;
}

std::string bytes_of(const Surface& surface) {
  return to_bytes(surface);
}

std::string bytes_of(const PointCloud& cloud) {
  return to_bytes(cloud);
}

} // namespace springproof::cases
