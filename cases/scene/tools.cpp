#include "cases/scene/tools.hpp"

#include "cases/mesh/closed_surface.hpp"
#include "cases/mesh/voxels.hpp"
#include "cases/scene/regions.hpp"

#include <algorithm>
#include <set>

namespace springproof::cases {

void read_surfaces(std::vector<Tool>& tools, std::vector<std::string>& remarks) {
  for (Tool& tool : tools) {
    auto* const surface = std::get_if<tools::Surface>(&tool.shape);
    if (!surface || !surface->triangles.empty()) continue; // a scene's own case has been read
    TriangleMesh read =
        rigid_surface(read_body_surface(surface->file, &remarks), surface->scale, surface->file, remarks);
    surface->vertices = std::move(read.vertices);
    surface->triangles = std::move(read.triangles);
  }
}

std::vector<FaceNodes> touched_faces(const Scene& scene, const Tool& tool) {
  std::vector<FaceNodes> faces = surface_faces(scene.mesh, scene.definition.symmetry);
  if (!tool.region) return faces;
  std::set<FaceNodes> of_region;
  for (const FaceNodes& face : select(scene.mesh, *tool.region).faces) of_region.insert(sorted(face));
  const auto is_elsewhere = [&](const FaceNodes& face) { return of_region.count(sorted(face)) == 0; };
  faces.erase(std::remove_if(faces.begin(), faces.end(), is_elsewhere), faces.end());
  if (faces.empty())
    refuse(tool.region->where, "'{}' has no face of the body's surface, and a tool touches faces",
           tool.region->name);
  return faces;
}

double shortest_side(const Scene& scene, const Tool& tool) {
  double shortest = INFINITY;
  for (const FaceNodes& face : touched_faces(scene, tool))
    for (std::size_t n = 0; n < face.size(); ++n) {
      const Eigen::Vector3d side =
          scene.mesh.nodes[index(face[(n + 1) % face.size()])] - scene.mesh.nodes[index(face[n])];
      shortest = std::min(shortest, side.norm());
    }
  return shortest;
}

} // namespace springproof::cases
