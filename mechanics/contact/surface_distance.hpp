#pragma once

#include "mechanics/contact/signed_distance.hpp"

#include <Eigen/Geometry>
#include <unsupported/Eigen/BVH>

namespace springproof::mechanics {

/// Exact distances from a closed surface of triangles. A tree of boxes finds the nearest triangle. Where its
/// inside, an edge or a vertex is nearest, the surface is a plane there, or the distance that from a line or
/// a point; inside is what lies behind the pseudonormal there, which at an edge is the sum of the triangles'
/// normals, and at a vertex that of all, weighted by their angles.
/// Source: J. A. Baerentzen and H. Aanaes, Signed distance computation using the angle weighted pseudonormal,
/// IEEE Transactions on Visualization and Computer Graphics 11 (2005).
class SurfaceDistance {
 public:
  /// @param surface  as cases::rigid_surface() makes it
  explicit SurfaceDistance(const cases::tools::Surface& surface);
  SignedDistance at(const Eigen::Vector3d& point) const;

 private:
  using Tree = Eigen::KdBVH<double, 3, int>;
  struct Nearest;

  std::vector<Eigen::Vector3d> vertices_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<Eigen::Vector3d> face_normals_;                ///< unit length
  std::vector<std::array<Eigen::Vector3d, 3>> edge_normals_; ///< a triangle's, at its edges from v to v + 1
  std::vector<Eigen::Vector3d> vertex_normals_;              ///< any length, as those of edges
  std::vector<std::vector<int>> neighbours_;                 ///< a vertex's, along edges
  double size_ = 0;                                          ///< mm
  Tree tree_;                                                ///< finds triangles by their boxes
};

} // namespace springproof::mechanics
