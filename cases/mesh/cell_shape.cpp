#include "cases/mesh/cell_shape.hpp"

#include "mechanics/hexahedron.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace springproof::cases {

using Eigen::Vector3d;

const std::array<std::array<int, 2>, 12> cell_edges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

const std::array<std::array<int, 2>, 12> cell_face_diagonals{
    {{0, 6}, {2, 4}, {1, 7}, {3, 5}, {0, 5}, {1, 4}, {2, 7}, {3, 6}, {0, 3}, {1, 2}, {4, 7}, {5, 6}}};

const std::array<std::array<int, 2>, 4> cell_internal_diagonals{{{0, 7}, {1, 6}, {2, 5}, {3, 4}}};

const std::array<std::array<int, 4>, 6> cell_faces{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

namespace {

/// Barycentric coordinates of a point of the reference tetrahedron: that of the origin first.
Eigen::Vector4d barycentric(const Vector3d& at) {
  return {1 - at.sum(), at.x(), at.y(), at.z()};
}

mechanics::HexahedronVertices as_hexahedron(const CellCorners& corners) {
  mechanics::HexahedronVertices vertices;
  std::copy(corners.begin(), corners.end(), vertices.begin());
  return vertices;
}

ReferenceCell make_hexahedron() {
  ReferenceCell cell{
      CellShape::hexahedron, "hexahedron", "hexahedra", 8, {cell_edges.begin(), cell_edges.end()}, {}, 1, {}};
  for (const auto& face : cell_faces) cell.faces.emplace_back(face.begin(), face.end());
  for (int q = 0; q < 8; ++q) cell.points.push_back(mechanics::gauss_point(q));
  return cell;
}

ReferenceCell make_tetrahedron() {
  const double a = (5 - std::sqrt(5.)) / 20, b = 1 - 3 * a; // Keast 1986
  return {CellShape::tetrahedron,
          "tetrahedron",
          "tetrahedra",
          4,
          {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}},
          {{0, 3, 2}, {0, 1, 3}, {0, 2, 1}, {1, 2, 3}},
          1. / 6,
          {{a, a, a}, {b, a, a}, {a, b, a}, {a, a, b}}};
}

} // namespace

const ReferenceCell& reference_cell(CellShape shape) {
  static const ReferenceCell hexahedron = make_hexahedron(), tetrahedron = make_tetrahedron();
  return shape == CellShape::tetrahedron ? tetrahedron : hexahedron;
}

ShapeValues shape_values(CellShape shape, const Vector3d& at) {
  if (shape == CellShape::tetrahedron) {
    const Eigen::Vector4d values = barycentric(at);
    return {values.begin(), values.end()};
  }
  const std::array<double, 8> values = mechanics::shape_values(at);
  return {values.begin(), values.end()};
}

ShapeGradients shape_gradients(CellShape shape, const Vector3d& at) {
  if (shape == CellShape::hexahedron) return mechanics::shape_gradients(at);
  ShapeGradients gradients(3, 4);
  gradients << -Vector3d::Ones(), Eigen::Matrix3d::Identity();
  return gradients;
}

Vector3d image(const CellCorners& corners, const Vector3d& at) {
  const ShapeValues shape = shape_values(shape_of(corners.size()), at);
  Vector3d point = Vector3d::Zero();
  for (std::size_t v = 0; v < corners.size(); ++v) point += shape[v] * corners[v];
  return point;
}

Eigen::Matrix3d jacobian(const CellCorners& corners, const Vector3d& at) {
  if (corners.size() == 8) return mechanics::jacobian(as_hexahedron(corners), at);
  Eigen::Matrix3d columns;
  for (std::size_t a = 0; a < 3; ++a) columns.col(static_cast<int>(a)) = corners[a + 1] - corners[0];
  return columns;
}

double distance_outside(CellShape shape, const Vector3d& at) {
  const double below = -at.minCoeff();
  return std::max({0., below, (shape == CellShape::tetrahedron ? at.sum() : at.maxCoeff()) - 1});
}

Vector3d moved_inside(CellShape shape, const Vector3d& at) {
  if (shape == CellShape::hexahedron) return at.cwiseMax(0).cwiseMin(1);
  const Vector3d positive = at.cwiseMax(0);
  return positive / std::max(1., positive.sum());
}

int face_at(CellShape shape, const Vector3d& at, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(at[axis]) <= tolerance) return shape == CellShape::hexahedron ? 2 * axis : axis;
    if (shape == CellShape::hexahedron && std::abs(at[axis] - 1) <= tolerance) return 2 * axis + 1;
  }
  return shape == CellShape::tetrahedron && std::abs(at.sum() - 1) <= tolerance ? 3 : -1;
}

double cell_volume(const CellCorners& corners) {
  const ReferenceCell& cell = reference_cell(shape_of(corners.size()));
  if (cell.shape == CellShape::tetrahedron)
    return cell.volume * jacobian(corners, Vector3d::Zero()).determinant();
  const mechanics::HexahedronVertices vertices = as_hexahedron(corners);
  double volume = 0;
  for (const Vector3d& point : cell.points) volume += mechanics::jacobian(vertices, point).determinant() / 8;
  return volume;
}

double smallest_corner_jacobian(const CellCorners& corners) {
  if (corners.size() == 4) return jacobian(corners, Vector3d::Zero()).determinant();
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t v = 0; v < 8; ++v) {
    const Vector3d& here = corners[v];
    const Vector3d x = corners[v ^ 1U] - here, y = corners[v ^ 2U] - here, z = corners[v ^ 4U] - here;
    const bool mirrored =
        ((v ^ (v >> 1U) ^ (v >> 2U)) & 1U) != 0; // an odd number of the edges leads backwards
    const double determinant = x.dot(y.cross(z));
    if (std::isnan(determinant)) return determinant; // std::min would drop it
    smallest = std::min(smallest, mirrored ? -determinant : determinant);
  }
  return smallest;
}

} // namespace springproof::cases
