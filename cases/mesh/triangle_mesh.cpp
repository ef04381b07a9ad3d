#include "cases/mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace springproof::cases {

using Eigen::Vector3d;

bool has_no_area(const std::array<Vector3d, 3>& triangle) {
  const Vector3d a = triangle[1] - triangle[0], b = triangle[2] - triangle[0];
  return !(a.cross(b).norm() > std::numeric_limits<float>::epsilon() * a.norm() * b.norm());
}

TriangleMesh joined(const Surface& surface) {
  TriangleMesh mesh;
  std::map<std::array<double, 3>, int> numbers; // by place
  for (const auto& corners : surface) {
    std::array<int, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3d at = corners[c] + Vector3d::Zero(); // -0 is 0
      const auto [number, is_new] =
          numbers.try_emplace({at.x(), at.y(), at.z()}, static_cast<int>(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(at);
      triangle[c] = number->second;
    }
    const auto& [a, b, c] = triangle;
    if (a != b && b != c && c != a) mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangleMesh triangles_of_faces(const Mesh& mesh, const std::vector<FaceNodes>& faces) {
  TriangleMesh outer;
  std::map<int, int> numbers; // by node
  for (const FaceNodes& face : faces) {
    FaceNodes vertices;
    for (const int node : face) {
      const auto [number, is_new] = numbers.try_emplace(node, static_cast<int>(outer.vertices.size()));
      if (is_new) outer.vertices.push_back(mesh.nodes[index(node)]);
      vertices.push_back(number->second);
    }
    for (std::size_t v = 2; v < vertices.size(); ++v)
      outer.triangles.push_back({vertices[0], vertices[v - 1], vertices[v]});
  }
  return outer;
}

Vector3d barycentre(const std::array<int, 3>& triangle, const std::vector<Vector3d>& positions) {
  const auto& [a, b, c] = triangle;
  return (positions[index(a)] + positions[index(b)] + positions[index(c)]) / 3;
}

Vector3d doubled_area(const std::array<int, 3>& triangle, const std::vector<Vector3d>& positions) {
  const Vector3d& origin = positions[index(triangle[0])];
  const Vector3d to_second = positions[index(triangle[1])] - origin;
  return to_second.cross(positions[index(triangle[2])] - origin);
}

} // namespace springproof::cases
