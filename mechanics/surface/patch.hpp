#pragma once

#include "mechanics/surface/embedded_surface.hpp"

namespace springproof::mechanics {

struct NodeWeight {
  int node;
  double weight;
};

/// The mean displacement of the part of a surface that lies in a sphere, as a sum over the nodes of the body:
/// its vertices there, by the areas of their triangles at rest (a third of each). A force on it that is
/// shared by these weights tends to a uniform traction as meshes are refined.
/// @param centre  mm, of the surface at rest     @param radius  mm, >= 0
/// @return in ascending order of nodes; the weights add up to 1. Nothing where no vertex lies in the sphere
std::vector<NodeWeight> patch_within(const EmbeddedSurface& surface, const Eigen::Vector3d& centre,
                                     double radius);

} // namespace springproof::mechanics
