#include "cases/scene/tools.hpp"

#include "cases/scene/regions.hpp"

#include <algorithm>
#include <set>

namespace springproof::cases {

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

} // namespace springproof::cases
