#include "cases/mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

/// Gives numbers to keys, in the order in which they are met.
template<class Key>
class Numbering {
 public:
  /// @return the number of a key, and whether it is a new one
  std::pair<int, bool> of(const Key& key) {
    const auto [place, is_new] = numbers_.try_emplace(key, static_cast<int>(numbers_.size()));
    return {place->second, is_new};
  }

 private:
  std::map<Key, int> numbers_;
};

} // namespace

TriangleMesh joined(const Surface& surface) {
  TriangleMesh mesh;
  Numbering<std::array<double, 3>> numbers;
  for (const auto& corners : surface) {
    std::array<int, 3> triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector3d at = corners[c] + Vector3d::Zero(); // -0 is 0
      const auto [number, is_new] = numbers.of({at.x(), at.y(), at.z()});
      if (is_new) mesh.vertices.push_back(at);
      triangle[c] = number;
    }
    const auto& [a, b, c] = triangle;
    if (a != b && b != c && c != a) mesh.triangles.push_back(triangle);
  }
  return mesh;
}

TriangleMesh triangles_of_faces(const HexMesh& mesh, const std::vector<std::array<int, 4>>& faces) {
  TriangleMesh outer;
  Numbering<int> numbers; // nodes' numbers
  for (const std::array<int, 4>& face : faces) {
    std::array<int, 4> vertices;
    for (std::size_t v = 0; v < 4; ++v) {
      const auto [number, is_new] = numbers.of(face[v]);
      if (is_new) outer.vertices.push_back(mesh.nodes[index(face[v])]);
      vertices[v] = number;
    }
    outer.triangles.push_back({vertices[0], vertices[1], vertices[2]});
    outer.triangles.push_back({vertices[0], vertices[2], vertices[3]});
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
