#pragma once

#include "cases/mesh/sharing.hpp"

#include <limits>

namespace springproof::cases {

/// A point that moves with a cell of the body.
struct CellPoint {
  std::size_t cell;
  Eigen::Vector3d at;     ///< the point or the nearest place of the body, in the reference cell
  Eigen::Vector3d beyond; ///< the way from there to the point, in its coordinates to first order
};

/// Weights of the cell's nodes in the point's displacement u = sum_v w_v u_v: the shape functions at a
/// point of the cell; outside, with the first order that leads there, so that a linear displacement is
/// reproduced and weights grow with the distance and no faster. They add up to 1.
ShapeValues weights_at(CellShape shape, const CellPoint& point);

/// The same point in the cell of refine(mesh) that has its place, which is half as large.
CellPoint refine(CellShape shape, const CellPoint& point);

struct WeightedPoint {
  CellPoint point;
  double weight;
};

struct NodeWeight {
  int node;
  double weight;
};

/// A weighted sum over points as one over the nodes of their cells.
/// @return in ascending order of nodes, without weights of 0
std::vector<NodeWeight> on_nodes(const std::vector<WeightedPoint>& points, const Mesh& mesh);

/// The cells of the body at rest that hold a point, in ascending order: one inside a cell, several on the
/// faces, edges and vertices between them, none outside the body. A cell's map is inverted by Newton's
/// method; 1e-6 of its edge counts as inside.
/// @param point  mm    @param among  the numbers of the cells that are looked at
std::vector<std::size_t> cells_at(const Mesh& mesh, const Eigen::Vector3d& point,
                                  const Range& among = {0, std::numeric_limits<std::size_t>::max()});

/// The place of a point in the reference cell, by Newton's method, to 1e-9 of the cell's largest edge: in it
/// or next to it. Nothing far outside of the cell, where its map may fold back.
/// @param point  mm
std::optional<Eigen::Vector3d> place_in_cell(const CellCorners& corners, const Eigen::Vector3d& point);

} // namespace springproof::cases
