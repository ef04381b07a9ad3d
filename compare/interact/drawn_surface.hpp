#pragma once

#include "mechanics/surface/embedded_surface.hpp"

#include <cstring>
#include <string>

namespace springproof::compare {

/// Adds a number for the page, little endian: its machine and the server's are one.
template<class To, class From>
void append(std::string& bytes, From value) {
  const To number = static_cast<To>(value);
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

inline void append(std::string& bytes, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) append<float>(bytes, vector[axis]);
}

/// What the page draws of a body.
struct DrawnSurface {
  /// A surface, and, where it has more than coarse_triangles, the same in about so many, for pages whose
  /// pictures a processor draws. Each is 4 counts as uint32 (vertices, triangles, nodes that carry both
  /// surfaces, spheres), then as float32 the vertices at rest (3 each) and their weights (8 each), as uint32
  /// their nodes' places in `nodes` (8 each), the triangles (3 each) and the spheres' vertices; the coarse
  /// one has no spheres. Little endian.
  std::string bytes;
  std::vector<int> nodes; ///< the body's nodes that carry vertices
};

constexpr std::size_t coarse_triangles = 5000;

/// @param spheres  vertices of the surface, their centres    @param mesh  that the surface is bound to
DrawnSurface drawn_surface(const mechanics::EmbeddedSurface& surface, const std::vector<int>& spheres,
                           const cases::HexMesh& mesh);

} // namespace springproof::compare
