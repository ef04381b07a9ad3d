#include "cases/mesh/surface.hpp"

#include "cases/mesh/vtk.hpp"

#include <cstdlib>
#include <map>

namespace springproof::cases {

using Eigen::Vector3d;

Surface read_stl(const std::string& path, const Where& where) {
  Surface surface;
  try {
    surface = vtk().read_triangles(path);
  } catch (const std::exception& error) {
    throw InputError(where, error.what());
  }
  if (surface.empty()) throw InputError(where, path + ": has no triangles");
  for (const auto& triangle : surface)
    for (const Vector3d& vertex : triangle)
      if (!vertex.allFinite()) throw InputError(where, path + ": has a position that is not finite");
  return surface;
}

std::size_t n_open_edges(const Surface& surface) {
  using Point = std::array<double, 3>;
  std::map<std::array<Point, 2>, long> balance; // of the edges between two points: one way less the other way
  const auto point = [](const Vector3d& v) {
    return Point{v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
  }; // -0 is 0
  for (const auto& triangle : surface)
    for (std::size_t v = 0; v < 3; ++v) {
      const Point a = point(triangle[v]), b = point(triangle[(v + 1) % 3]);
      if (a < b) ++balance[{a, b}];
      if (b < a) --balance[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& [edge, difference] : balance) open += static_cast<std::size_t>(std::labs(difference));
  return open;
}

} // namespace springproof::cases
