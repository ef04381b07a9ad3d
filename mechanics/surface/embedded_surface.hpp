#pragma once

#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/triangle_mesh.hpp"

namespace springproof::mechanics {

/// A place of a body of hexahedra, as a sum over the nodes of one of its cells.
struct EmbeddedPoint {
  std::array<int, 8> nodes;
  std::array<double, 8> weights; ///< add up to 1; negative ones outside of the cell
  cases::CellPoint place;        ///< what the weights are of
};

/// A surface that a body takes along.
struct EmbeddedSurface {
  cases::TriangleMesh rest;
  std::vector<EmbeddedPoint> vertices; ///< one per vertex of it
  std::size_t n_outside = 0;           ///< of the vertices, those in no cell
  double largest_distance = 0;         ///< mm: how far one of them is from the nearest cell
};

/// Binds the vertices of a surface to the cells of a body at rest. A vertex in a cell has the weights of its
/// trilinear coordinates there. One outside is bound to the nearest point of the nearest cell, and its
/// weights are extrapolated from there to first order: u(X) = u(P) + grad u(P) (X - P). So a linear
/// displacement is reproduced wherever a vertex lies, a turned body turns all of its surface, and weights
/// grow with the distance and no faster, as trilinear coordinates outside of their cell would.
/// @throws std::runtime_error if the nearest cell of a vertex is degenerate there
EmbeddedSurface embed(cases::TriangleMesh surface, const cases::HexMesh& mesh);

/// Displacement of an embedded point.  @param displacement  of the body's nodes, mm
Eigen::Vector3d displacement_at(const EmbeddedPoint& point, const std::vector<Eigen::Vector3d>& displacement);

/// Where the surface is.  @param displacement  of the body's nodes, mm
/// @param positions  of the surface's vertices, mm, overwritten
void move(const EmbeddedSurface& surface, const std::vector<Eigen::Vector3d>& displacement,
          std::vector<Eigen::Vector3d>& positions);

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
