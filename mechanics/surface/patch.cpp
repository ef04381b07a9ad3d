#include "mechanics/surface/patch.hpp"

#include <map>

namespace springproof::mechanics {

std::vector<cases::WeightedPoint> patch_within(const EmbeddedSurface& surface, const Eigen::Vector3d& centre,
                                               double radius) {
  const auto& positions = surface.rest.vertices;
  const double reach = radius + 1e-9 * (1 + centre.norm()); // what a recording rounds
  std::map<int, double> area;                               // mm², of vertices in the sphere
  double whole = 0;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if ((positions[v] - centre).norm() <= reach) area.emplace(static_cast<int>(v), 0);
  for (const auto& triangle : surface.rest.triangles) {
    double third = 0;
    for (const int vertex : triangle)
      if (const auto found = area.find(vertex); found != area.end()) {
        if (third == 0) third = cases::doubled_area(triangle, positions).norm() / 6;
        found->second += third;
        whole += third;
      }
  }
  std::vector<cases::WeightedPoint> points;
  for (const auto& [vertex, share] : area)
    points.push_back({surface.vertices[cases::index(vertex)].place,
                      whole > 0 ? share / whole : 1 / static_cast<double>(area.size())});
  return points;
}

} // namespace springproof::mechanics
