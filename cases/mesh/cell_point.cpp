#include "cases/mesh/cell_point.hpp"

#include "cases/mesh/cell_children.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

namespace springproof::cases {

using Eigen::Vector3d;

namespace {

constexpr double on_boundary = 1e-6; ///< part of the reference cell, and of a cell's largest edge
constexpr int most_steps = 30;       ///< Newton's method takes 2 to 6 in cells that are not nearly degenerate

double largest_edge(const Eigen::AlignedBox3d& box) {
  return box.sizes().maxCoeff();
}

bool holds(const CellCorners& corners, const Vector3d& point) {
  const Eigen::AlignedBox3d box = bounding_box(corners);
  if (box.exteriorDistance(point) > on_boundary * largest_edge(box)) return false;
  const auto at = place_in_cell(corners, point);
  return at && distance_outside(shape_of(corners.size()), *at) <= on_boundary;
}

/// Finds the cells that touch the point's neighbourhood, in ascending order, in a grid whose cells are all
/// present.
std::vector<std::size_t> cells_near(const Grid& grid, const Vector3d& point) {
  const auto place_of = [&](int axis, double aside) {
    const double at = (point[axis] - grid.origin[axis]) / grid.spacing[axis] + aside;
    return static_cast<int>(std::clamp(std::floor(at), 0., grid.cells[index(axis)] - 1.));
  };
  std::array<int, 3> first, last;
  for (int axis = 0; axis < 3; ++axis) {
    first[index(axis)] = place_of(axis, -2 * on_boundary);
    last[index(axis)] = place_of(axis, 2 * on_boundary);
  }
  std::vector<std::size_t> cells;
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i)
        cells.push_back((index(k) * index(grid.cells[1]) + index(j)) * index(grid.cells[0]) + index(i));
  return cells;
}

} // namespace

ShapeValues weights_at(CellShape shape, const CellPoint& point) {
  ShapeValues weights = shape_values(shape, point.at);
  const ShapeGradients gradients = shape_gradients(shape, point.at);
  for (std::size_t v = 0; v < weights.size(); ++v)
    weights[v] += gradients.col(static_cast<Eigen::Index>(v)).dot(point.beyond);
  return weights;
}

CellCorners child_corners(CellShape shape, std::size_t child) {
  CellCorners corners;
  if (shape == CellShape::tetrahedron) {
    const auto vertex = [](int v) { return Vector3d(v == 1, v == 2, v == 3); };
    for (const auto& [a, b] : tetrahedron_children[child]) corners.push_back((vertex(a) + vertex(b)) / 2);
    return corners;
  }
  const auto vertex = [](std::size_t v) {
    return Vector3d(static_cast<double>(v & 1U), static_cast<double>(v >> 1U & 1U),
                    static_cast<double>(v >> 2U));
  };
  for (std::size_t v = 0; v < 8; ++v) corners.push_back((vertex(v) + vertex(child)) / 2);
  return corners;
}

namespace {

/// The child of a tetrahedron that holds a point, or comes nearest to it.
CellPoint in_child_of_tetrahedron(const CellPoint& point) {
  const CellShape shape = CellShape::tetrahedron;
  CellPoint best{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t child = 0; child < 8; ++child) {
    const CellCorners corners = child_corners(shape, child);
    const Eigen::Matrix3d to_child = jacobian(corners, Vector3d::Zero()).inverse();
    const Vector3d at = to_child * (point.at - corners[0]);
    const double outside = distance_outside(shape, at);
    if (outside >= least) continue;
    least = outside;
    best = {8 * point.cell + child, moved_inside(shape, at), to_child * point.beyond};
  }
  return best;
}

} // namespace

CellPoint refine(CellShape shape, const CellPoint& point) {
  if (shape == CellShape::tetrahedron) return in_child_of_tetrahedron(point);
  CellPoint fine{8 * point.cell, 2 * point.at, 2 * point.beyond};
  for (int axis = 0; axis < 3; ++axis)
    if (point.at[axis] >= 0.5) { // child i + 2j + 4k is at (i, j, k)
      fine.cell += std::size_t{1} << axis;
      fine.at[axis] -= 1;
    }
  return fine;
}

std::vector<NodeWeight> on_nodes(const std::vector<WeightedPoint>& points, const Mesh& mesh) {
  std::map<int, double> weight; // by node
  for (const auto& [point, part] : points) {
    const CellNodes nodes = mesh.cells[point.cell];
    const ShapeValues weights = weights_at(mesh.shape, point);
    for (std::size_t n = 0; n < nodes.size(); ++n) weight[nodes[n]] += part * weights[n];
  }
  std::vector<NodeWeight> weights;
  for (const auto& [node, share] : weight)
    if (share != 0) weights.push_back({node, share});
  return weights;
}

std::optional<Vector3d> place_in_cell(const CellCorners& corners, const Vector3d& point) {
  const double size = largest_edge(bounding_box(corners));
  Vector3d at = Vector3d::Constant(0.25); // inside of either shape, and in the middle of the tetrahedron
  if (corners.size() == 8) at.setConstant(0.5);
  for (int step = 0; step < most_steps; ++step) {
    const Vector3d missing = point - image(corners, at);
    if (missing.norm() <= 1e-3 * on_boundary * size) return at;
    at += jacobian(corners, at).partialPivLu().solve(missing);
    if (!(at.array().abs() <= 10).all()) return std::nullopt;
  }
  return std::nullopt;
}

std::vector<std::size_t> cells_at(const Mesh& mesh, const Vector3d& point, const Range& among) {
  std::vector<std::size_t> cells;
  const auto look_at = [&](std::size_t cell) {
    if (holds(cell_corners(mesh, cell), point)) cells.push_back(cell);
  };
  const auto [begin, end] = among.common({0, mesh.cells.size()});
  if (mesh.nodes.rule && mesh.cells.rule && mesh.grid) { // a look at eight cells out of 10^7 is enough
    for (const std::size_t cell : cells_near(*mesh.grid, point))
      if (among.has(cell)) look_at(cell);
    return cells;
  }
  for (std::size_t cell = begin; cell < end; ++cell) look_at(cell);
  return cells;
}

} // namespace springproof::cases
