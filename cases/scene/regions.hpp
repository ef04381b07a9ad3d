#pragma once

#include "cases/case/case.hpp"
#include "cases/mesh/mesh.hpp"

#include <functional>

/// Selections by the kinds of regions on a mesh; select() in scene.hpp finds the kind.
namespace springproof::cases {

/// Nodes, edges and faces on all of these planes of the mesh's bounding box. On a grid whose cells are all
/// present they follow from numbers, without a look at the inner ones.
/// @param faces  names of the box's faces, such as "z+" and "x-"
Selection select_on_planes(const Mesh& mesh, const std::vector<std::string>& faces);

/// Bits of the planes of symmetry that each node is on, by their place in the list; empty without planes.
std::vector<int> planes_of_nodes(const Mesh& mesh, const std::vector<Fixed>& symmetry);

/// Faces of the body's surface: they have one cell, and lie on no plane of symmetry, where the body goes on.
std::vector<FaceNodes> surface_faces(const Mesh& mesh, const std::vector<Fixed>& symmetry);

/// The faces of the surface whose centre lies in the region's sphere, or whose vertices lie on its plane,
/// with their edges and nodes.
/// @param surface  surface_faces()
Selection select_patch(const Mesh& mesh, const std::vector<FaceNodes>& surface, const Region& region);

/// Calls action(region) for every region of a definition.
template<class Action>
void for_each_region_of(Case& definition, const Action& action) {
  for (Fixed& fixed : definition.fixed) action(fixed.region);
  for (Moved& moved : definition.moved) action(moved.region);
  for (Load& load : definition.loads) action(load.region);
  for (AddedMass& mass : definition.masses) action(mass.region);
  for (Tool& tool : definition.tools)
    if (tool.region) action(*tool.region);
  for (Measure& measure : definition.measures)
    for_each_region(measure, [&](Region& region, bool) { action(region); });
}

/// Puts the node that is meant in the place of each point that a node nearest to it is asked for, in all
/// regions of a definition. Refined meshes have the node too, and the point may have a nearer one there.
/// @param remarks  receives how far each is
/// @throws InputError if the nearest is further away than the region's tolerance
void find_nearest_nodes(const Mesh& mesh, Case& definition, std::vector<std::string>& remarks);

/// Selected nodes, and the edges and faces between them of some cells or of all.
Selection select_between(const Mesh& mesh, const std::vector<bool>& is_selected,
                         const std::function<bool(std::size_t cell)>& is_of_cells = {});

} // namespace springproof::cases
