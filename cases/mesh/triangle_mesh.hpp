#pragma once

#include "cases/mesh/mesh.hpp"

namespace springproof::cases {

/// A surface of triangles, seen from outside anticlockwise, whose corners have no numbers; mm.
using Surface = std::vector<std::array<Eigen::Vector3d, 3>>;

/// Whether the corners are in a line, to single precision.
bool has_no_area(const std::array<Eigen::Vector3d, 3>& triangle);

/// A surface of triangles that share their vertices.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;     ///< mm
  std::vector<std::array<int, 3>> triangles; ///< numbers of vertices, seen from outside anticlockwise
};

/// Joins vertices with equal coordinates, and drops triangles that have one of these twice.
TriangleMesh joined(const Surface& surface);

/// Faces as triangles: a quadrangle as two.
TriangleMesh triangles_of_faces(const Mesh& mesh, const std::vector<FaceNodes>& faces);

/// Barycentre of a triangle at given positions of the vertices, mm.
Eigen::Vector3d barycentre(const std::array<int, 3>& triangle, const std::vector<Eigen::Vector3d>& positions);

/// Twice a triangle's area times its unit normal, mm²; outwards.
Eigen::Vector3d doubled_area(const std::array<int, 3>& triangle,
                             const std::vector<Eigen::Vector3d>& positions);

} // namespace springproof::cases
