#pragma once

#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/triangle_mesh.hpp"

namespace springproof::mechanics {

/// A place of a body, as a sum over the nodes of one of its cells.
struct EmbeddedPoint {
  cases::CellNodes nodes;
  cases::ShapeValues weights; ///< add up to 1; negative ones outside of the cell
  cases::CellPoint place;     ///< the place that has these weights
};

/// A surface that a body takes along.
struct EmbeddedSurface {
  cases::TriangleMesh rest;
  std::vector<EmbeddedPoint> vertices; ///< one per vertex of it
  std::size_t n_outside = 0;           ///< vertices in no cell
  double largest_distance = 0;         ///< mm, from a vertex to the nearest cell
};

/// Binds the vertices of a surface to the cells of a body at rest. A vertex in a cell has the weights of its
/// coordinates in the cell. One outside is bound to the nearest point of the nearest cell, and its
/// weights are extrapolated from there to first order: u(X) = u(P) + grad u(P) (X - P). So a linear
/// displacement is reproduced wherever a vertex lies, a turned body turns all of its surface, and weights
/// grow with the distance and no faster, as trilinear coordinates outside of their cell would.
/// @throws std::runtime_error if the nearest cell of a vertex is degenerate there
EmbeddedSurface embed(cases::TriangleMesh surface, const cases::Mesh& mesh);

/// Displacement of an embedded point.  @param displacement  mm, one per node of the body
Eigen::Vector3d displacement_at(const EmbeddedPoint& point, const std::vector<Eigen::Vector3d>& displacement);

/// Moves a surface with its body.  @param displacement  mm, one per node of the body
/// @param positions  mm, one per vertex of the surface, overwritten
void move(const EmbeddedSurface& surface, const std::vector<Eigen::Vector3d>& displacement,
          std::vector<Eigen::Vector3d>& positions);

/// The part of a surface that lies in a sphere, for its mean displacement: its vertices there, each weighted
/// with a third of its triangles' areas at rest. A force on the part is shared by the same weights;
/// cases::on_nodes() has those of the body's nodes. With ever smaller cells the load tends to a uniform
/// traction while the cells are larger than the triangles; with smaller ones, the vertices are point forces.
/// @param centre  mm, in the surface at rest     @param radius  mm, >= 0
/// @return points in ascending order of vertices, whose weights add up to 1; empty where no vertex lies in
/// the sphere
std::vector<cases::WeightedPoint> patch_within(const EmbeddedSurface& surface, const Eigen::Vector3d& centre,
                                               double radius);

} // namespace springproof::mechanics
