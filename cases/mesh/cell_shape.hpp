#pragma once

#include "cases/case/enumeration.hpp"

#include <Eigen/Core>
#include <array>
#include <boost/container/static_vector.hpp>
#include <vector>

/// Cells of the kinds that a mesh may have, as maps of a reference cell: the trilinear hexahedron, whose
/// vertex v = i + 2j + 4k sits at (i, j, k) in the unit cube, and the linear tetrahedron, whose vertices sit
/// at the origin and at 1 on the axes x, y, z.
namespace springproof::cases {

SPRINGPROOF_ENUMERATION(CellShape, hexahedron, tetrahedron)

/// Lists without memory of their own.
template<class Value, std::size_t most>
using Few = boost::container::static_vector<Value, most>;
using CellNodes = Few<int, 8>;               ///< numbers of a cell's vertices
using FaceNodes = Few<int, 4>;               ///< around a face
using CellCorners = Few<Eigen::Vector3d, 8>; ///< places of a cell's vertices, mm
using ShapeValues = Few<double, 8>;          ///< one per vertex
using ShapeGradients = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 8>; ///< a column a vertex

/// The 12 edges, 12 face diagonals and 4 internal diagonals of a hexahedron, and its 6 faces (anticlockwise
/// from outside).
extern const std::array<std::array<int, 2>, 12> cell_edges;
extern const std::array<std::array<int, 2>, 12> cell_face_diagonals;
extern const std::array<std::array<int, 2>, 4> cell_internal_diagonals;
extern const std::array<std::array<int, 4>, 6> cell_faces; ///< x-, x+, y-, y+, z-, z+

/// A hexahedron's vertices as gmsh, VTK and CalculiX number them: around its bottom, then around its top.
constexpr std::array<std::size_t, 8> around_cell{0, 1, 3, 2, 4, 5, 7, 6};

/// Edges and faces of a cell by its vertices. Faces are given as seen from outside, anticlockwise.
struct ReferenceCell {
  CellShape shape;
  const char *name, *names; ///< singular and plural, for messages
  std::size_t n_vertices;
  std::vector<std::array<int, 2>> edges;
  std::vector<FaceNodes> faces;
  double volume; ///< without a unit
  /// Points in the reference cell of equal weight, exact for polynomials of degree 2 at least.
  std::vector<Eigen::Vector3d> points;
};
const ReferenceCell& reference_cell(CellShape shape);

/// The shape of a cell with so many vertices, 4 or 8.
inline CellShape shape_of(std::size_t n_vertices) {
  return n_vertices == 4 ? CellShape::tetrahedron : CellShape::hexahedron;
}

/// The shape functions, which add up to 1.
/// @param at  coordinates of a point in the reference cell or outside
ShapeValues shape_values(CellShape shape, const Eigen::Vector3d& at);

/// Gradients of the shape functions with respect to the reference cell's coordinates.
ShapeGradients shape_gradients(CellShape shape, const Eigen::Vector3d& at);

/// Where a cell's map takes a point of the reference cell, mm.
Eigen::Vector3d image(const CellCorners& corners, const Eigen::Vector3d& at);

/// Jacobian matrix of the map, mm.
Eigen::Matrix3d jacobian(const CellCorners& corners, const Eigen::Vector3d& at);

/// How far a point lies outside the reference cell: the largest amount by which it passes a face; 0 inside.
double distance_outside(CellShape shape, const Eigen::Vector3d& at);

/// The point in the reference cell that a point is moved to by what it passes the faces.
Eigen::Vector3d moved_inside(CellShape shape, const Eigen::Vector3d& at);

/// The face that a point of the reference cell lies on to a tolerance, by its number; -1: on none.
int face_at(CellShape shape, const Eigen::Vector3d& at, double tolerance);

/// Volume of a cell with these vertices, mm³; negative when it is inside out. Exact.
double cell_volume(const CellCorners& corners);

/// The smallest Jacobian determinant of the map from the unit cube at a hexahedron's corners, or of that from
/// the reference tetrahedron, mm³: not above 0 for an inverted or degenerate cell, not a number where a
/// vertex is none.
double smallest_corner_jacobian(const CellCorners& corners);

} // namespace springproof::cases
