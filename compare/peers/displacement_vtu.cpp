#include "compare/peers/displacement_file.hpp"

#include "cases/case/error.hpp"
#include "cases/mesh/vtk.hpp"

#include <fmt/format.h>
#include <limits>
#include <set>

namespace springproof::compare {

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw cases::InputError(path + ": " + problem);
}

cases::PointCloud points_of(const std::string& text, const std::string& path) {
  try {
    return cases::vtk().read_unstructured_grid(text);
  } catch (const std::exception& error) {
    refuse(path, std::string("is no complete VTK file of type UnstructuredGrid: ") + error.what());
  }
}

/// Finds the displacements by their name, or takes the only vectors.
const std::vector<Eigen::Vector3d>& displacements_of(const std::vector<cases::PointField>& fields,
                                                     const std::string& path) {
  for (const char* wanted : {"msm_displacement", "displacement"})
    for (const cases::PointField& field : fields)
      if (field.name == wanted) return field.values;
  if (fields.size() == 1) return fields.front().values;
  std::string names;
  for (const cases::PointField& field : fields) names += " '" + field.name + "'";
  refuse(path, "must have point data of three components (Float32 or Float64) named msm_displacement or "
               "displacement, or only one with three components; it has" +
                   (names.empty() ? " none" : names));
}

} // namespace

std::vector<GivenDisplacement> read_displacement_vtu(const std::string& text, const std::string& path) {
  const cases::PointCloud cloud = points_of(text, path);
  const std::vector<Eigen::Vector3d>& displacements = displacements_of(cloud.fields, path);
  const double rounding = cloud.is_single_precision ? std::numeric_limits<float>::epsilon() : 0;
  std::vector<GivenDisplacement> nodes;
  std::set<std::array<double, 6>> known; // pieces have the points between them in common
  for (std::size_t p = 0; p < displacements.size(); ++p) {
    const Eigen::Vector3d &x = cloud.points[p], &u = displacements[p];
    if (!x.allFinite() || !u.allFinite()) refuse(path, fmt::format("is not finite at point {}", p));
    if (known.insert({x[0], x[1], x[2], u[0], u[1], u[2]}).second)
      nodes.push_back({x, u, fmt::format("{}: point {}", path, p), rounding * x.norm()});
  }
  return nodes;
}

} // namespace springproof::compare
