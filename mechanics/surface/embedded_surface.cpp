#include "mechanics/surface/embedded_surface.hpp"

#include "cases/mesh/cell_point.hpp"
#include "cases/mesh/vtk_functions.hpp"

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <stdexcept>

namespace springproof::mechanics {

using Eigen::Vector3d;

namespace {

/// Returns the step, to first order, from a point of the reference cell to the one that the map takes to
/// `place`.
Vector3d step_to(const Vector3d& place, const cases::CellCorners& corners, const Vector3d& at) {
  return cases::jacobian(corners, at).partialPivLu().solve(place - cases::image(corners, at));
}

} // namespace

EmbeddedSurface embed(cases::TriangleMesh surface, const cases::Mesh& mesh) {
  EmbeddedSurface embedded;
  const auto places = cases::vtk().nearest_in_cells(mesh, surface.vertices);
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) {
    const auto& [cell, nearest] = places[v];
    const cases::CellCorners corners = cases::cell_corners(mesh, cell);
    // VTK finds the cell and its nearest point to some digits; what these lack, the first order adds.
    const Vector3d at = cases::place_in_cell(corners, nearest).value_or(Vector3d::Constant(0.25));
    const Vector3d inside = cases::moved_inside(mesh.shape, at);
    const cases::CellPoint place{cell, inside, step_to(surface.vertices[v], corners, inside)};
    embedded.vertices.push_back({mesh.cells[cell], cases::weights_at(mesh.shape, place), place});
    for (const double weight : embedded.vertices.back().weights)
      if (!std::isfinite(weight))
        throw std::runtime_error("the cell nearest to vertex " + std::to_string(v) +
                                 " of the surface is degenerate");
    const double distance = (surface.vertices[v] - nearest).norm();
    if (distance > 0) ++embedded.n_outside;
    embedded.largest_distance = std::max(embedded.largest_distance, distance);
  }
  embedded.rest = std::move(surface);
  return embedded;
}

Vector3d displacement_at(const EmbeddedPoint& point, const std::vector<Vector3d>& displacement) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t v = 0; v < point.nodes.size(); ++v)
    sum += point.weights[v] * displacement[cases::index(point.nodes[v])];
  return sum;
}

void move(const EmbeddedSurface& surface, const std::vector<Vector3d>& displacement,
          std::vector<Vector3d>& positions) {
  positions.resize(surface.vertices.size());
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] = surface.rest.vertices[v] + displacement_at(surface.vertices[v], displacement);
}

std::vector<cases::WeightedPoint> patch_within(const EmbeddedSurface& surface, const Eigen::Vector3d& centre,
                                               double radius) {
  const auto& positions = surface.rest.vertices;
  const double reach = radius + 1e-9 * (1 + centre.norm()); // what a recording rounds
  std::map<int, double> area;                               // mm², by vertex in the sphere
  double whole = 0;
  for (std::size_t v = 0; v < positions.size(); ++v)
    if ((positions[v] - centre).norm() <= reach) area.emplace(static_cast<int>(v), 0);
  for (const auto& triangle : surface.rest.triangles) {
    double third = 0;
    for (const int vertex : triangle)
      if (const auto found = area.find(vertex); found != area.end()) {
        if (third == 0) third = cases::doubled_area(triangle, positions).norm() / 6;
        found->second += third;
        whole += third;
      }
  }
  std::vector<cases::WeightedPoint> points;
  for (const auto& [vertex, share] : area)
    points.push_back({surface.vertices[cases::index(vertex)].place,
                      whole > 0 ? share / whole : 1 / static_cast<double>(area.size())});
  return points;
}

} // namespace springproof::mechanics
