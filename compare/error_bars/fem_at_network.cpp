#include "compare/error_bars/auto_fem.hpp"

#include "cases/case/error.hpp"
#include "compare/measure/measure.hpp"
#include "mechanics/surface/embedded_surface.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using cases::index;
using Eigen::Vector3d;

/// A network's nodes in the cells of the finite elements.
struct PlacesInCells {
  mechanics::EmbeddedSurface nodes; ///< vertices without triangles
  std::size_t n_outside = 0;        ///< further from the nearest cell than positions are known
  double largest_distance = 0;      ///< mm, of those
};

/// @throws InputError if a node lies further outside of all cells than half the diagonal of the closest
PlacesInCells places_in_cells(const cases::Scene& network, const cases::Mesh& mesh) {
  const auto& body = std::get<cases::Network>(network.definition.body);
  PlacesInCells found;
  try {
    found.nodes = mechanics::embed({network.mesh.nodes.to_vector(), {}}, mesh);
  } catch (const std::runtime_error& error) {
    throw cases::InputError(body.nodes.where, fmt::format("[fem.body]: {}", error.what()));
  }
  const double undecided = 1e-6 * cases::bounding_box(mesh.nodes).diagonal().norm();
  for (std::size_t n = 0; n < found.nodes.vertices.size(); ++n) {
    const cases::CellPoint& place = found.nodes.vertices[n].place;
    const cases::CellCorners corners = cases::cell_corners(mesh, place.cell);
    const double distance = (found.nodes.rest.vertices[n] - cases::image(corners, place.at)).norm();
    if (distance <= undecided) continue;
    ++found.n_outside;
    found.largest_distance = std::max(found.largest_distance, distance);
    if (!(distance <= cases::bounding_box(corners).diagonal().norm() / 2))
      refuse(
          body.nodes.where,
          "node {} at ({:.6g}) lies {:.3g} mm outside of [fem.body], must lie in it, or outside by no more "
          "than half a cell's diagonal: are both in mm, and in the same place?",
          n, fmt::join(found.nodes.rest.vertices[n], ", "), distance);
  }
  return found;
}

/// Displacement gradients at the nodes of a mesh: the mean of the gradients of their cells.
std::vector<Eigen::Matrix3d> gradients_at_nodes(const cases::Mesh& mesh,
                                                const std::vector<Vector3d>& displacement) {
  std::vector<Eigen::Matrix3d> gradients(mesh.nodes.size(), Eigen::Matrix3d::Zero());
  std::vector<int> n_cells(mesh.nodes.size(), 0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const Eigen::Matrix3d gradient =
        deformation_gradient(mesh, c, displacement) - Eigen::Matrix3d::Identity();
    for (const int node : mesh.cells[c]) {
      gradients[index(node)] += gradient;
      ++n_cells[index(node)];
    }
  }
  for (std::size_t n = 0; n < gradients.size(); ++n) gradients[n] /= n_cells[n];
  return gradients;
}

std::vector<Vector3d> at_nodes(const PlacesInCells& places, const std::vector<Vector3d>& displacement) {
  std::vector<Vector3d> values;
  for (const mechanics::EmbeddedPoint& place : places.nodes.vertices)
    values.push_back(mechanics::displacement_at(place, displacement));
  return values;
}

/// The displacement at the nodes by quadratic functions: u = sum_v w_v (u_v + grad u_v (x - x_v)/2). A linear
/// interpolation differs from it by the curvature of the displacement in the cell.
std::vector<Vector3d> quadratic_at_nodes(const PlacesInCells& places, const cases::Mesh& mesh,
                                         const std::vector<Vector3d>& displacement) {
  const std::vector<Eigen::Matrix3d> gradients = gradients_at_nodes(mesh, displacement);
  std::vector<Vector3d> values = at_nodes(places, displacement);
  for (std::size_t n = 0; n < values.size(); ++n) {
    const mechanics::EmbeddedPoint& place = places.nodes.vertices[n];
    for (std::size_t v = 0; v < place.nodes.size(); ++v) {
      const std::size_t node = index(place.nodes[v]);
      const Vector3d arm = places.nodes.rest.vertices[n] - mesh.nodes[node];
      values[n] += place.weights[v] / 2 * (gradients[node] * arm);
    }
  }
  return values;
}

/// What displacements say of a network, which has no cells and no finite elements' forces.
void bring_to_nodes(const PlacesInCells& places, cases::Solution& solution) {
  if (solution.status != cases::Status::converged) return;
  solution.displacement = at_nodes(places, solution.displacement);
  solution.cell_volume.clear();
  solution.fields.reset();
  solution.norms.reset();
}

} // namespace

Answers solve_fem_at_network(const cases::Scene& network, int n_meshes) {
  const cases::Scene& of_fem = network.of_fem.front();
  const PlacesInCells places = places_in_cells(network, of_fem.mesh);
  Answers answers = solve_fem(of_fem, n_meshes, {});
  Interpolated how;
  how.side = cases::Side::fem;
  how.n_points = of_fem.mesh.nodes.size();
  how.n_outside = places.n_outside;
  how.largest_distance = places.largest_distance;
  if (answers.fem.converged()) {
    how.fem_and_back.solution.status = cases::Status::converged;
    how.fem_and_back.solution.displacement =
        quadratic_at_nodes(places, of_fem.mesh, answers.fem.solution.displacement);
  }
  bring_to_nodes(places, answers.fem.solution);
  if (answers.refined)
    for (cases::Solution& solution : answers.refined->solutions) bring_to_nodes(places, solution);
  answers.interpolated = std::move(how);
  return answers;
}

} // namespace springproof::compare
