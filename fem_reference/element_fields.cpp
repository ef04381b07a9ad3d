#include "fem_reference/element_fields.hpp"

#include "cases/scene/loads.hpp"
#include "mechanics/hexahedron.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

ElementPlace place_of(std::size_t refined_cell, int n_refinements) {
  ElementPlace place{refined_cell >> (3 * n_refinements), Vector3d::Zero(), 1};
  for (int level = n_refinements - 1; level >= 0; --level) { // the first refinement's octant comes first
    const std::size_t octant = refined_cell >> (3 * level) & 7;
    place.edge /= 2;
    for (int a = 0; a < 3; ++a)
      if (octant >> a & 1) place.lower[a] += place.edge;
  }
  return place;
}

ElementFields::ElementFields(const cases::Scene& scene, Kinematics kinematics, std::vector<Vector3d> nodes,
                             const cases::Range& cells)
    : scene_(scene), kinematics_(kinematics), nodes_(std::move(nodes)),
      sums_(cases::vertices_of(scene.mesh, cells), cells) {}

void ElementFields::add(const ElementState& element) {
  const auto& [place, geometry, displacement, force, energy] = element;
  const std::array<int, 8> vertices = scene_.mesh.cells[place.cell];
  const std::array<Vector3d, 8> corners = cases::cell_vertices(scene_.mesh, place.cell);
  const bool is_linear = kinematics_ == Kinematics::linear; // the virial is that of the body at rest
  const Vector3d first(displacement);
  mechanics::CellSums& sum = sums_.cell(place.cell);
  for (int a = 0; a < geometry.n_nodes; ++a) {
    const std::array<double, 8> shape = mechanics::shape_values(place.lower + place.edge * nodes_[index(a)]);
    const Vector3d f(force[a], force[geometry.n_nodes + a], force[2 * geometry.n_nodes + a]);
    Vector3d at = is_linear ? Vector3d(0, 0, 0) : Vector3d(Vector3d(displacement + 3 * a) - first);
    for (std::size_t v = 0; v < 8; ++v) {
      at += shape[v] * (corners[v] - corners[0]); // forces add up to 0: any origin serves
      sums_.force(index(vertices[v])) += shape[v] * f;
    }
    sum.virial() += f * at.transpose();
  }
  double rest_volume = 0;
  for (int q = 0; q < geometry.n_points; ++q) {
    rest_volume += geometry.weights[q];
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < geometry.n_nodes; ++a) {
        const double gradient = geometry.gradients[(3 * q + j) * geometry.n_nodes + a];
        sum.gradient().col(j) += geometry.weights[q] * gradient * Vector3d(displacement + 3 * a);
      }
  }
  sum.rest_volume() += rest_volume;
  sum.volume() += is_linear ? rest_volume : CellKernel::deformed_volume(geometry, displacement);
  sum.energy() += energy;
}

namespace {

/// Whether elements give each node the same load as the scene does. They do not for forces and masses that a
/// region's nodes share on a refined mesh, nor for the weight of cells that are no boxes.
mechanics::Balance balance_of(const cases::Scene& scene) {
  const bool has_gravity = !cases::gravity(scene).isZero(0);
  bool is_shared_by_nodes = has_gravity && !scene.masses.empty();
  for (const auto& applied : scene.loads)
    is_shared_by_nodes = is_shared_by_nodes || cases::is<cases::loads::TotalForce>(applied.load);
  const bool differs =
      (scene.definition.fem.refine > 0 && is_shared_by_nodes) || (has_gravity && !scene.mesh.grid);
  return differs ? mechanics::Balance::as_a_whole : mechanics::Balance::at_nodes;
}

} // namespace

cases::Fields ElementFields::fields(const cases::Sharing* sharing, double load_factor) {
  return mechanics::fields_of(scene_, std::move(sums_), sharing,
                              {load_factor,
                               kinematics_ == Kinematics::linear ? mechanics::StrainMeasure::linear
                                                                 : mechanics::StrainMeasure::logarithmic,
                               cases::PointMass::cells,
                               load_factor == 0 ? mechanics::Balance::not_asked : balance_of(scene_)});
}

namespace {

/// Lagrange's polynomial on the unit interval: 1 at one of the nodes 0, 1/degree, ... 1 and 0 at the others.
double lagrange(int degree, double node, double x) {
  double value = 1;
  for (int other = 0; other <= degree; ++other)
    if (const double at = double(other) / degree; std::abs(at - node) > 1e-9) value *= (x - at) / (node - at);
  return value;
}

} // namespace

DisplacementNorms::DisplacementNorms(int degree, const std::vector<Vector3d>& nodes) {
  const int n = degree + 1; // Gauss points along an axis, x fastest
  const double offset = degree == 1 ? 0.5 / std::sqrt(3.) : std::sqrt(0.15);
  for (int q = 0; q < n * n * n; ++q)
    for (const Vector3d& node : nodes) {
      double& value = shape_.emplace_back(1);
      const int place[3] = {q % n, q / n % n, q / (n * n)};
      for (int a = 0; a < 3; ++a)
        value *= lagrange(degree, node[a], 0.5 + (2. * place[a] / degree - 1) * offset);
    }
}

void DisplacementNorms::add(const CellGeometry& geometry, const double* displacement) {
  const int n = geometry.n_nodes;
  for (int q = 0; q < geometry.n_points; ++q) {
    Vector3d value = Vector3d::Zero();
    for (int a = 0; a < n; ++a) value += shape_[index(q * n + a)] * Vector3d(displacement + 3 * a);
    integral_ += geometry.weights[q] * value.squaredNorm();
    volume_ += geometry.weights[q];
  }
  for (int a = 0; a < n; ++a) largest_ = mechanics::larger(largest_, Vector3d(displacement + 3 * a).norm());
}

cases::FieldNorms DisplacementNorms::norms(const cases::Sharing* sharing) const {
  if (!sharing) return {std::sqrt(integral_ / volume_), largest_};
  return {std::sqrt(sharing->sum(integral_) / sharing->sum(volume_)), sharing->largest(largest_)};
}

bool has_own_norms(const cases::Case& definition, int degree) {
  const auto is_norm = [](const cases::Measure& measure) { return cases::is_field_norm(measure.kind); };
  return (degree > 1 || definition.fem.refine > 0) &&
         std::any_of(definition.measures.begin(), definition.measures.end(), is_norm);
}

} // namespace springproof::fem_reference
