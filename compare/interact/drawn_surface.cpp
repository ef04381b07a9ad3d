#include "compare/interact/drawn_surface.hpp"

#include "cases/mesh/vtk_functions.hpp"

#include <stdexcept>

namespace springproof::compare {

namespace {

/// The surface in fewer triangles; none if it is small or cannot be had in fewer: the page draws all of it.
std::vector<mechanics::EmbeddedSurface> coarse_surface(const cases::TriangleMesh& fine,
                                                       const cases::HexMesh& mesh) {
  if (fine.triangles.size() <= coarse_triangles) return {};
  try {
    return {mechanics::embed(cases::decimated(fine, coarse_triangles), mesh)};
  } catch (const std::runtime_error&) {
    return {};
  }
}

} // namespace

DrawnSurface drawn_surface(const mechanics::EmbeddedSurface& surface, const std::vector<int>& spheres,
                           const cases::HexMesh& mesh) {
  DrawnSurface drawn;
  std::vector<mechanics::EmbeddedSurface> surfaces = coarse_surface(surface.rest, mesh);
  surfaces.insert(surfaces.begin(), surface);
  std::vector<int> place(mesh.nodes.size(), -1);
  for (const auto& each : surfaces)
    for (const auto& vertex : each.vertices)
      for (const int node : vertex.nodes)
        if (int& here = place[cases::index(node)]; here < 0) {
          here = static_cast<int>(drawn.nodes.size());
          drawn.nodes.push_back(node);
        }
  for (const auto& each : surfaces) {
    const bool has_spheres = &each == &surfaces.front();
    for (const std::size_t count : {each.vertices.size(), each.rest.triangles.size(), drawn.nodes.size(),
                                    has_spheres ? spheres.size() : 0})
      append<std::uint32_t>(drawn.bytes, count);
    for (const Eigen::Vector3d& vertex : each.rest.vertices) append(drawn.bytes, vertex);
    for (const auto& vertex : each.vertices)
      for (const double weight : vertex.weights) append<float>(drawn.bytes, weight);
    for (const auto& vertex : each.vertices)
      for (const int node : vertex.nodes) append<std::uint32_t>(drawn.bytes, place[cases::index(node)]);
    for (const auto& triangle : each.rest.triangles)
      for (const int vertex : triangle) append<std::uint32_t>(drawn.bytes, vertex);
    if (!has_spheres) continue;
    for (const int vertex : spheres) append<std::uint32_t>(drawn.bytes, vertex);
  }
  return drawn;
}

} // namespace springproof::compare
