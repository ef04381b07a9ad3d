#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

/// The trilinear hexahedron as a map of the unit cube: vertex v = i + 2j + 4k sits at (i, j, k). This
/// includes nothing of the project, so that meshes can use it.
namespace springproof::mechanics {

using HexahedronVertices = std::array<Eigen::Vector3d, 8>; ///< mm

/// Point q of the 2x2x2 Gauss rule, each of weight 1/8: q = i + 2j + 4k as for vertices.
inline Eigen::Vector3d gauss_point(int q) {
  const double at[2] = {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  return {at[q & 1], at[(q >> 1) & 1], at[q >> 2]};
}

/// The eight shape functions, which add up to 1, in the order of the vertices.
/// @param at  coordinates of a point in the unit cube or outside
inline std::array<double, 8> shape_values(const Eigen::Vector3d& at) {
  std::array<double, 8> values;
  for (std::size_t v = 0; v < 8; ++v) {
    values[v] = 1;
    for (int a = 0; a < 3; ++a) values[v] *= (v >> a) & 1 ? at[a] : 1 - at[a];
  }
  return values;
}

/// Where the map takes a point of the unit cube, mm.
inline Eigen::Vector3d image(const HexahedronVertices& vertices, const Eigen::Vector3d& at) {
  const std::array<double, 8> shape = shape_values(at);
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < 8; ++v) point += shape[v] * vertices[v];
  return point;
}

/// Gradients of the shape functions with respect to the unit cube's coordinates, one column a vertex.
inline Eigen::Matrix<double, 3, 8> shape_gradients(const Eigen::Vector3d& at) {
  Eigen::Matrix<double, 3, 8> gradients = Eigen::Matrix<double, 3, 8>::Ones();
  for (int v = 0; v < 8; ++v)
    for (int d = 0; d < 3; ++d)
      for (int a = 0; a < 3; ++a) {
        const bool is_upper = (v >> a) & 1;
        gradients(d, v) *= a == d ? (is_upper ? 1 : -1) : (is_upper ? at[a] : 1 - at[a]);
      }
  return gradients;
}

/// Jacobian matrix of the map, mm.
inline Eigen::Matrix3d jacobian(const HexahedronVertices& vertices, const Eigen::Vector3d& at) {
  Eigen::Matrix3d columns = Eigen::Matrix3d::Zero();
  for (int d = 0; d < 3; ++d) // the four edges along d, weighted by how near they are
    for (int edge = 0; edge < 4; ++edge) {
      const int e = (d + 1) % 3, f = (d + 2) % 3, on_e = edge & 1, on_f = edge >> 1,
                v = (on_e << e) | (on_f << f);
      const double weight = (on_e ? at[e] : 1 - at[e]) * (on_f ? at[f] : 1 - at[f]);
      columns.col(d) +=
          weight * (vertices[static_cast<std::size_t>(v | (1 << d))] - vertices[static_cast<std::size_t>(v)]);
    }
  return columns;
}

} // namespace springproof::mechanics
