#include "cases/mesh/closed_surface.hpp"

#include "cases/mesh/voxels.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/pending/disjoint_sets.hpp>
#include <numeric>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr std::size_t most_rigid_triangles = 500'000; ///< the tree of their boxes then takes 0.2 GB

std::string place_of(const Vector3d& point) {
  return fmt::format("({:.6g})", fmt::join(point, ", "));
}

double sum(const std::vector<double>& numbers) {
  return std::accumulate(numbers.begin(), numbers.end(), 0.);
}

} // namespace

void check_is_closed(const TriangleMesh& surface, const NamedFile& file, const std::string& or_else) {
  std::map<std::array<int, 2>, int> n_triangles;
  for (const auto& triangle : surface.triangles)
    for (std::size_t v = 0; v < 3; ++v) ++n_triangles[sorted(std::array{triangle[v], triangle[(v + 1) % 3]})];
  const auto refuse_if = [&](const auto& is_wrong, const std::string& what, const std::string& remedy) {
    const auto counts = [&](const auto& entry) { return is_wrong(entry.second); };
    const auto first = std::find_if(n_triangles.begin(), n_triangles.end(), counts);
    if (first == n_triangles.end()) return;
    const auto& [a, b] = first->first;
    file.refuse(fmt::format(what, std::count_if(n_triangles.begin(), n_triangles.end(), counts)) +
                fmt::format(", one of them from {} to {} mm: ", place_of(surface.vertices[index(a)]),
                            place_of(surface.vertices[index(b)])) +
                remedy);
  };
  refuse_if([](int n) { return n == 1; }, "is open: {} of its edges belong to one triangle",
            "close its holes (MeshLab: Filters, Remeshing, Close Holes)");
  refuse_if([](int n) { return n > 2; },
            "is no surface of one body: {} of its edges belong to more than two triangles",
            "take parts that touch apart (MeshLab: Repair Non Manifold Edges)" + or_else);
  if (const std::size_t n = n_open_edges(surface))
    file.refuse(fmt::format("has triangles that are turned over: {} of its edges run the same way in both of "
                            "their triangles; turn them (MeshLab: Re-Orient All Faces Coherently)",
                            n / 2));
}

std::vector<double> volumes_of_parts(const TriangleMesh& surface) {
  boost::disjoint_sets_with_storage<> parts(surface.vertices.size());
  for (const auto& [a, b, c] : surface.triangles) {
    parts.union_set(index(a), index(b));
    parts.union_set(index(a), index(c));
  }
  std::map<std::size_t, double> volumes; // by a vertex of the part
  for (const auto& triangle : surface.triangles)
    volumes[parts.find_set(index(triangle[0]))] +=
        doubled_area(triangle, surface.vertices).dot(surface.vertices[index(triangle[0])]) / 6;
  std::vector<double> all;
  for (const auto& [part, volume] : volumes) all.push_back(volume);
  return all;
}

double area_of(const TriangleMesh& surface) {
  double area = 0;
  for (const auto& triangle : surface.triangles) area += doubled_area(triangle, surface.vertices).norm() / 2;
  return area;
}

bool has_volume(const TriangleMesh& surface) {
  constexpr double flat = 1e-9;
  return std::abs(sum(volumes_of_parts(surface))) >
         flat * area_of(surface) * bounding_box(surface.vertices).sizes().maxCoeff();
}

TriangleMesh rigid_surface(const Surface& triangles, double scale, const NamedFile& file,
                           std::vector<std::string>& remarks) {
  TriangleMesh surface = joined(triangles);
  if (surface.triangles.empty()) file.refuse("has no triangle with three different corners");
  if (surface.triangles.size() > most_rigid_triangles)
    file.refuse(fmt::format("has {} triangles, must have at most {}; a surface finer than the body's cells "
                            "changes nothing (MeshLab: Quadric Edge Collapse Decimation)",
                            surface.triangles.size(), most_rigid_triangles));
  double size = 0;
  for (Vector3d& vertex : surface.vertices) size = std::max(size, (vertex *= scale).cwiseAbs().maxCoeff());
  if (!(1e-6 <= size && size <= 1e9))
    file.refuse(fmt::format("reaches {:.3g} mm from its origin, must reach 1e-6 to 1e9; scale says how many "
                            "mm a unit of the file is",
                            size));
  check_is_closed(surface, file);
  for (const auto& [a, b, c] : surface.triangles) {
    const Vector3d& at = surface.vertices[index(a)];
    if (has_no_area({at, surface.vertices[index(b)], surface.vertices[index(c)]}))
      file.refuse(fmt::format("has a triangle without an area at {} mm, which faces nowhere: merge vertices "
                              "that are close, and remove T-vertices (MeshLab: Cleaning and Repairing)",
                              place_of(at)));
  }
  if (!has_volume(surface))
    file.refuse("encloses no volume: its triangles lie in a plane, or double each other");
  const std::vector<double> volumes = volumes_of_parts(surface);
  const double volume = sum(volumes);
  const auto is_turned = [&](double part) { return !(volume > 0 ? part > 0 : part < 0); };
  if (const auto n = std::count_if(volumes.begin(), volumes.end(), is_turned))
    file.refuse(fmt::format("has {} of {} parts whose triangles are turned the other way than the rest: turn "
                            "them (MeshLab: Invert Faces Orientation), or remove cavities",
                            n, volumes.size()));
  if (volume > 0) return surface;
  for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
  remarks.push_back(file.path + ": its triangles are seen from outside clockwise, and are turned over");
  return surface;
}

} // namespace springproof::cases
