#include "compare/peers/external_side.hpp"

#include "cases/case/error.hpp"
#include "cases/case/input_file.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <utility>

namespace springproof::compare {

using Eigen::Vector3d;

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& problem) {
  throw cases::InputError(path + ": " + problem);
}

cases::PointCloud points_of(const std::string& text, const std::string& path) try {
  return cases::read_point_cloud(text);
} catch (const std::exception& error) {
  refuse(path, std::string("is no VTK file that can be read: ") + error.what());
}

/// Finds the displacements by their name, or takes the only vectors.
const std::vector<Vector3d>& displacements_of(const cases::PointCloud& cloud, const std::string& path,
                                              const std::string& array) {
  const std::vector<std::string> names_of_ours{"msm_displacement", "displacement"};
  for (const std::string& wanted : array.empty() ? names_of_ours : std::vector{array})
    for (const cases::PointField& field : cloud.fields)
      if (field.name == wanted) return field.values;
  if (array.empty() && cloud.fields.size() == 1) return cloud.fields.front().values;
  std::vector<std::string> names;
  for (const cases::PointField& field : cloud.fields) names.push_back("'" + field.name + "'");
  names.insert(names.end(), cloud.others.begin(), cloud.others.end());
  refuse(path, fmt::format(
                   "must have point data of three components (Float32 or Float64) named {}; it has {}",
                   array.empty() ? "msm_displacement or displacement, or only one with three components, or "
                                   "one that --array names"
                                 : "'" + array + "'",
                   names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

std::string shown(const Vector3d& point) {
  return fmt::format("({:.10g}, {:.10g}, {:.10g})", point.x(), point.y(), point.z());
}

} // namespace

void read_displacement_rows(
    const std::string& text, const std::string& path, const std::string& header,
    const std::function<void(const std::vector<double>&, const std::string&)>& row_of) {
  const auto n_columns = static_cast<std::size_t>(std::count(header.begin(), header.end(), ',') + 1);
  const auto refuse_row = [&](const cases::TextRow& row, const std::string& problem) {
    throw cases::InputError(
        fmt::format("{}is '{}', must be {} {} (mm)", row.place(), row.line, problem, header));
  };
  bool has_heading = false;
  const auto check_heading = [&](const cases::TextRow& row) {
    has_heading = true;
    if (fmt::format("{}", fmt::join(row.fields, ",")) != header) refuse_row(row, "the header");
  };
  cases::read_rows(text, path, cases::Between::commas, check_heading, [&](const cases::TextRow& row) {
    if (!has_heading) refuse_row(row, "the header");
    std::vector<double> values;
    for (const std::string_view field : row.fields)
      if (const auto value = cases::number_in<double>(field)) values.push_back(*value);
    if (values.size() != n_columns || row.fields.size() != n_columns)
      refuse_row(row, fmt::format("{} finite numbers between commas:", n_columns == 6 ? "six" : "seven"));
    row_of(values, fmt::format("{}:{}", path, row.number));
  });
  if (!has_heading) throw cases::InputError(path + ":1: is empty, must begin with the header " + header);
}

std::vector<GivenDisplacement> read_displacement_csv(const std::string& text, const std::string& path) {
  std::vector<GivenDisplacement> nodes;
  read_displacement_rows(text, path, "x,y,z,ux,uy,uz",
                         [&](const std::vector<double>& v, const std::string& where) {
                           nodes.push_back({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, where});
                         });
  return nodes;
}

std::vector<GivenDisplacement> read_displacement_vtk(const std::string& text, const std::string& path,
                                                     const std::string& array) {
  return displacements_in(points_of(text, path), path, array);
}

const std::vector<Vector3d>& finite_displacements(const cases::PointCloud& cloud, const std::string& path,
                                                  const std::string& array) {
  const std::vector<Vector3d>& displacements = displacements_of(cloud, path, array);
  for (std::size_t p = 0; p < displacements.size(); ++p)
    if (!cloud.points[p].allFinite() || !displacements[p].allFinite())
      refuse(path, fmt::format("is not finite at point {}", p));
  return displacements;
}

std::vector<GivenDisplacement> displacements_in(const cases::PointCloud& cloud, const std::string& path,
                                                const std::string& array) {
  const std::vector<Vector3d>& displacements = finite_displacements(cloud, path, array);
  // A float in text may have six digits, and be off by five millionths in each component.
  const double rounding = cloud.is_single_precision ? 1e-5 : 0;
  std::vector<GivenDisplacement> nodes;
  std::set<std::array<double, 6>> known; // pieces have the points between them in common
  for (std::size_t p = 0; p < displacements.size(); ++p) {
    const Vector3d &x = cloud.points[p], &u = displacements[p];
    if (known.insert({x[0], x[1], x[2], u[0], u[1], u[2]}).second)
      nodes.push_back({x, u, fmt::format("{}: point {}", path, p), rounding * x.lpNorm<Eigen::Infinity>()});
  }
  return nodes;
}

double same_place(const cases::Mesh& mesh) {
  return 1e-6 * cases::bounding_box(mesh.nodes).diagonal().norm();
}

std::vector<Vector3d> match_nodes(const cases::Mesh& mesh, const std::vector<GivenDisplacement>& given,
                                  const std::string& path) {
  std::vector<Vector3d> positions, displacement;
  for (const GivenDisplacement& next : given) positions.push_back(next.position);
  const std::vector<std::size_t> nearest = cases::vtk().nearest_points(mesh.nodes.to_vector(), positions);
  std::vector<const GivenDisplacement*> of_node(mesh.nodes.size(), nullptr);
  const double nearest_allowed = same_place(mesh);
  for (std::size_t g = 0; g < given.size(); ++g) {
    const GivenDisplacement& next = given[g];
    const Vector3d& node = mesh.nodes[nearest[g]];
    const double tolerance = nearest_allowed + next.rounding;
    if (!((node - next.position).norm() <= tolerance))
      throw cases::InputError(fmt::format("{}: no node of the case's mesh lies within {:.2g} mm of {}; the "
                                          "nearest is {}. Results on another mesh "
                                          "need --interpolate",
                                          next.where, tolerance, shown(next.position), shown(node)));
    if (const GivenDisplacement* known = std::exchange(of_node[nearest[g]], &next))
      throw cases::InputError(fmt::format("{}: the node {} is given twice, first in {}", next.where,
                                          shown(next.position), known->where));
  }
  for (std::size_t n = 0; n < of_node.size(); ++n) {
    if (!of_node[n])
      throw cases::InputError(
          fmt::format("{}: has {} of the {} nodes of the case's mesh, must have all: {} is missing", path,
                      given.size(), mesh.nodes.size(), shown(mesh.nodes[n])));
    displacement.push_back(of_node[n]->displacement);
  }
  return displacement;
}

} // namespace springproof::compare
