#include "cases/scene/surface.hpp"

#include "cases/mesh/labels.hpp"
#include "cases/mesh/vtk_functions.hpp"
#include "cases/scene/regions.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::cases {

namespace {

/// Drops triangles on planes of symmetry: no part of the surface, beyond them the body goes on.
void open_at_symmetry(const HexMesh& mesh, const std::vector<Fixed>& symmetry, TriangleMesh& surface) {
  for (const Fixed& plane : symmetry) {
    const int axis = plane.region.name[0] - 'x';
    const double at = mesh.nodes[index(select_on_planes(mesh, {plane.region.name}).nodes.front())][axis];
    const auto is_on_plane = [&](const std::array<int, 3>& triangle) {
      return std::all_of(triangle.begin(), triangle.end(), [&](int vertex) {
        return std::abs(surface.vertices[index(vertex)][axis] - at) <= 1e-6 * (1 + std::abs(at));
      });
    };
    auto& triangles = surface.triangles;
    triangles.erase(std::remove_if(triangles.begin(), triangles.end(), is_on_plane), triangles.end());
  }
}

} // namespace

void read_surface_of(Scene& scene) {
  constexpr std::size_t most = 5'000'000;
  const auto& named = scene.definition.surface;
  if (!named) return;
  try {
    scene.surface = named->contour ? label_surface(std::get<Labels>(scene.definition.body), *named->contour)
                                   : read_surface(named->file.path, &scene.remarks);
    for (Eigen::Vector3d& vertex : scene.surface.vertices) vertex *= named->scale;
  } catch (const std::runtime_error& error) {
    named->file.refuse_once(error.what());
  }
  if (scene.surface.triangles.size() > most)
    named->file.refuse(
        fmt::format("has {} triangles, must have at most {}", scene.surface.triangles.size(), most));
  open_at_symmetry(scene.mesh, scene.definition.symmetry, scene.surface);
}

} // namespace springproof::cases
