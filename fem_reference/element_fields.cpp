#include "fem_reference/element_fields.hpp"

#include "cases/mesh/cell_children.hpp"
#include "cases/scene/loads.hpp"
#include "mechanics/larger.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

ElementPlace place_of(cases::CellShape shape, std::size_t refined_cell, int n_refinements) {
  ElementPlace place{refined_cell >> (3 * n_refinements), Vector3d::Zero(), Eigen::Matrix3d::Identity()};
  for (int level = n_refinements - 1; level >= 0; --level) { // the first refinement's child comes first
    const cases::CellCorners child = cases::child_corners(shape, refined_cell >> (3 * level) & 7);
    place.origin += place.axes * child[0];
    place.axes *= cases::jacobian(child, Vector3d::Zero());
  }
  return place;
}

namespace {

/// Adds an element's part of the fields.
/// @param nodes  an element's, in its reference cell     @param force  CellResult::plain_force, N
void add(mechanics::FieldSums& sums, const cases::Scene& scene, const std::vector<Vector3d>& nodes,
         const ElementState& element, bool is_linear, const Eigen::VectorXd& force, double energy) {
  const auto& [place, geometry, displacement, internal] = element;
  const cases::CellNodes vertices = scene.mesh.cells[place.cell];
  const cases::CellCorners corners = cases::cell_corners(scene.mesh, place.cell);
  const Vector3d first(displacement);
  mechanics::CellSums& sum = sums.cell(place.cell);
  for (int a = 0; a < geometry.n_nodes; ++a) {
    const cases::ShapeValues shape =
        cases::shape_values(scene.mesh.shape, place.origin + place.axes * nodes[index(a)]);
    const Vector3d f(force[a], force[geometry.n_nodes + a], force[2 * geometry.n_nodes + a]);
    // the virial of linear kinematics is that of the body at rest
    Vector3d at = is_linear ? Vector3d(0, 0, 0) : Vector3d(Vector3d(displacement + 3 * a) - first);
    for (std::size_t v = 0; v < corners.size(); ++v) {
      at += shape[v] * (corners[v] - corners[0]); // forces add up to 0: any origin serves
      sums.force(index(vertices[v])) += shape[v] * f;
    }
    sum.virial() += f * at.transpose();
  }
  double rest_volume = 0;
  for (int q = 0; q < geometry.n_points; ++q) {
    rest_volume += geometry.weights[q];
    for (int j = 0; j < 3; ++j)
      for (int a = 0; a < geometry.n_nodes; ++a) {
        const double gradient = geometry.gradients[(3 * q + j) * geometry.n_functions + a];
        sum.gradient().col(j) += geometry.weights[q] * gradient * Vector3d(displacement + 3 * a);
      }
  }
  sum.rest_volume() += rest_volume;
  sum.volume() += is_linear ? rest_volume : CellKernel::deformed_volume(geometry, displacement);
  sum.energy() += energy;
}

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

cases::Fields fields_of(const ElementsInState& elements, const cases::Sharing* sharing, double load_factor) {
  const cases::Scene& scene = elements.scene;
  const auto kernels = kernels_of(elements.formulations, elements.type);
  const bool is_linear = elements.formulations.front().kinematics == Kinematics::linear;
  mechanics::FieldSums sums(cases::vertices_of(scene.mesh, elements.cells), elements.cells);
  elements.for_each([&](const ElementState& element) {
    CellKernel& kernel = *kernels[index(cases::material_of(scene, element.place.cell))];
    const CellResult& result =
        kernel.evaluate(element.geometry, element.displacement, element.internal, Wanted::stress);
    add(sums, scene, elements.nodes, element, is_linear, result.plain_force,
        kernel.energy(element.geometry, element.displacement, element.internal));
  });
  return mechanics::fields_of(
      scene, std::move(sums), sharing,
      {load_factor, is_linear ? mechanics::StrainMeasure::linear : mechanics::StrainMeasure::logarithmic,
       cases::PointMass::cells, load_factor == 0 ? mechanics::Balance::not_asked : balance_of(scene),
       elements.tools});
}

cases::FieldNorms displacement_norms(const ElementsInState& elements, const cases::Sharing* sharing) {
  double integral = 0, volume = 0, largest = 0;
  elements.for_each([&](const ElementState& element) {
    const Eigen::Map<const Eigen::Matrix3Xd> at_nodes(element.displacement, 3, element.geometry.n_nodes);
    integral += (at_nodes * elements.products(element.geometry)).cwiseProduct(at_nodes).sum();
    volume +=
        std::accumulate(element.geometry.weights, element.geometry.weights + element.geometry.n_points, 0.);
    for (const auto& at_node : at_nodes.colwise()) largest = mechanics::larger(largest, at_node.norm());
  });
  if (!sharing) return {std::sqrt(integral / volume), largest};
  return {std::sqrt(sharing->sum(integral) / sharing->sum(volume)), sharing->largest(largest)};
}

std::optional<cases::FieldNorms> norms_of(const ElementsInState& elements, const cases::Sharing* sharing) {
  const cases::Case& definition = elements.scene.definition;
  const auto is_norm = [](const cases::Measure& measure) { return cases::is_field_norm(measure.kind); };
  const bool are_measured = (elements.type.degree > 1 || definition.fem.refine > 0) &&
                            std::any_of(definition.measures.begin(), definition.measures.end(), is_norm);
  return are_measured ? std::optional(displacement_norms(elements, sharing)) : std::nullopt;
}

} // namespace springproof::fem_reference
