#pragma once

#include "mechanics/surface/embedded_surface.hpp"

namespace springproof::mechanics {

/// The part of a surface that lies in a sphere, for its mean displacement: its vertices there, by the areas
/// of their triangles at rest (a third of each). A force on it is shared by the same weights;
/// cases::on_nodes() has those of the body's nodes. On bodies of ever smaller cells the load tends to a
/// uniform traction while the cells are larger than the triangles; on smaller ones, the vertices are point
/// forces.
/// @param centre  mm, of the surface at rest     @param radius  mm, >= 0
/// @return in ascending order of vertices; the weights add up to 1. Nothing where no vertex lies in the
/// sphere
std::vector<cases::WeightedPoint> patch_within(const EmbeddedSurface& surface, const Eigen::Vector3d& centre,
                                               double radius);

} // namespace springproof::mechanics
