#include "fem_reference/geometry.hpp"

#include "fem_reference/space.hpp"
#include "mechanics/shape_products.hpp"

#include <cmath>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <numeric>

namespace springproof::fem_reference {

using cases::index;
using Eigen::Vector3d;

/// deal.II numbers the components of every support point one after another: a node is a block of them.
Nodes::Nodes(const Space& space, const cases::Scene& scene) {
  const dealii::IndexSet& owned = space.dofs.locally_owned_dofs();
  dealii::IndexSet ghosts = dealii::DoFTools::extract_locally_active_dofs(space.dofs);
  ghosts.subtract_set(owned);
  const unsigned n = space.element.n_components();
  for (const auto& dofs : {owned, ghosts})
    for (const auto dof : dofs)
      if (dof % n == 0) global.push_back(static_cast<PetscInt>(dof / n));
  n_owned = static_cast<int>(owned.n_elements() / n);
  per_cell = static_cast<int>(space.node_element->n_dofs_per_cell());
  for (const auto& at : space.node_element->get_unit_support_points()) {
    in_reference_cell.emplace_back(at[0], at[1], at[2]);
    between.emplace_back();
    const cases::ShapeValues weights = cases::shape_values(space.shape, in_reference_cell.back());
    for (std::size_t v = 0; v < weights.size(); ++v) // they are 1, 1/2, 1/4 or 1/8, or zero
      if (weights[v] > 0.1) between.back().push_back(static_cast<int>(v));
  }

  point.resize(global.size());
  mesh_node.assign(global.size(), -1);
  std::vector<dealii::types::global_dof_index> dofs(space.element.n_dofs_per_cell());
  for (const auto& cell : space.own_cells()) {
    cell->get_dof_indices(dofs);
    mesh_cell.push_back(cell->index());
    const auto& cell_vertices = scene.mesh.cells[index(mesh_cell.back())];
    for (unsigned a = 0; a < space.node_element->n_dofs_per_cell(); ++a) {
      const auto dof = dofs[space.element.component_to_system_index(0, a)];
      const auto node = owned.is_element(dof)
                            ? owned.index_within_set(dof) / n
                            : static_cast<unsigned>(n_owned) + ghosts.index_within_set(dof) / n;
      of_cell.push_back(static_cast<int>(node));
      point[node].setZero();
      for (const int v : between[a])
        point[node] +=
            scene.mesh.nodes[index(cell_vertices[index(v)])] / static_cast<double>(between[a].size());
      if (between[a].size() == 1) mesh_node[node] = cell_vertices[index(between[a][0])];
    }
  }
  n_cells = static_cast<int>(mesh_cell.size());
}

Vector Nodes::make_vector(MPI_Comm communicator, int n) const {
  const auto n_ghosts = static_cast<PetscInt>(global.size()) - n_owned;
  Vector vector(get<Vec>(VecCreateGhostBlock, communicator, n, n * n_owned, PETSC_DECIDE, n_ghosts,
                         global.data() + n_owned));
  check(VecSet(vector.get(), 0));
  return vector;
}

namespace {

std::vector<double> shape_values_at(const Space& space, const dealii::Quadrature<3>& points) {
  std::vector<double> values;
  for (const auto& at : points.get_points())
    for (unsigned a = 0; a < space.node_element->n_dofs_per_cell(); ++a)
      values.push_back(space.node_element->shape_value(a, at));
  return values;
}

/// Integrals of N_a N_b over the reference tetrahedron and its volume, by a rule of degree 5.
Eigen::MatrixXd mean_products_of_tetrahedron(const Space& space) {
  const dealii::QWitherdenVincentSimplex<3> rule(3);
  std::vector<double> weights = rule.get_weights();
  const double volume = cases::reference_cell(cases::CellShape::tetrahedron).volume;
  return mechanics::shape_products(static_cast<int>(space.node_element->n_dofs_per_cell()),
                                   static_cast<int>(rule.size()), shape_values_at(space, rule).data(),
                                   weights.data(), 1 / volume);
}

} // namespace

Geometry::Geometry(const Space& space, const Nodes& nodes, const ElementType& element)
    : nodes_(nodes), n_modes_(element.n_pressure_modes), n_bubbles_(element.n_bubbles) {
  const dealii::Quadrature<3>& quadrature = space.quadrature;
  dealii::FEValues<3> values(*space.mapping, *space.node_element, quadrature,
                             dealii::update_gradients | dealii::update_JxW_values);
  n_points = static_cast<int>(quadrature.size());
  shape_values = shape_values_at(space, quadrature);
  if (space.shape == cases::CellShape::tetrahedron) mean_products_ = mean_products_of_tetrahedron(space);
  dealii::FEValues<3> centre(*space.mapping, *space.node_element, dealii::QMidpoint<3>(),
                             dealii::update_inverse_jacobians | dealii::update_JxW_values);
  gradients_.reserve(3 * index(nodes.n_cells) * index(n_points) * index(nodes.per_cell + n_bubbles_));
  int n_cells = 0;
  for (const auto& cell : space.own_cells()) {
    const auto& active = static_cast<const dealii::Triangulation<3>::active_cell_iterator&>(cell);
    values.reinit(active);
    if (n_bubbles_ > 0) centre.reinit(active);
    for (const unsigned q : values.quadrature_point_indices()) {
      weights_.push_back(values.JxW(q));
      for (unsigned j = 0; j < 3; ++j) {
        for (const unsigned a : values.dof_indices()) gradients_.push_back(values.shape_grad(a, q)[j]);
        // Gradient of 4 x_b (1 - x_b), by the map at the centre, so that it is 0 in the mean.
        for (unsigned b = 0; b < static_cast<unsigned>(n_bubbles_); ++b)
          gradients_.push_back((4 - 8 * quadrature.point(q)[b]) * centre.inverse_jacobian(0)[b][j] *
                               centre.JxW(0) * quadrature.weight(q) / values.JxW(q));
      }
    }
    if (element.pressure == Pressure::nodes)
      add_vertex_modes(space);
    else
      add_pressure_modes(n_cells++);
  }
}

/// 1 and the coordinates from the cell's centre over its edge length. Coordinates of the reference cell would
/// lose an order of accuracy on cells that are no parallelepipeds (Arnold, Boffi and Falk, Math. Comp. 71,
/// 2002).
void Geometry::add_pressure_modes(int cell) {
  if (n_modes_ == 0) return;
  const double* weights = weights_.data() + cell * n_points;
  Vector3d centre = Vector3d::Zero();
  double volume = 0;
  for (int q = 0; q < n_points; ++q) {
    centre += weights[q] * point(cell, q);
    volume += weights[q];
  }
  centre /= volume;
  for (int q = 0; q < n_points; ++q) {
    const Vector3d offset = (point(cell, q) - centre) / std::cbrt(volume);
    for (int m = 0; m < n_modes_; ++m) modes_.push_back(m == 0 ? 1 : offset[m - 1]);
  }
}

void Geometry::add_vertex_modes(const Space& space) {
  for (const auto& at : space.quadrature.get_points()) {
    const cases::ShapeValues values = cases::shape_values(space.shape, {at[0], at[1], at[2]});
    modes_.insert(modes_.end(), values.begin(), values.begin() + n_modes_);
  }
}

CellGeometry Geometry::of(int cell) const {
  const auto first = index(cell) * index(n_points);
  const int n_functions = nodes_.per_cell + n_bubbles_;
  return {nodes_.per_cell,
          n_functions,
          n_points,
          gradients_.data() + first * 3 * index(n_functions),
          weights_.data() + first,
          modes_.data() + first * index(n_modes_)};
}

Eigen::MatrixXd Geometry::products(const CellGeometry& cell) const {
  if (mean_products_.size() == 0)
    return mechanics::shape_products(cell.n_nodes, n_points, shape_values.data(), cell.weights, 1);
  return std::accumulate(cell.weights, cell.weights + n_points, 0.) * mean_products_;
}

Eigen::MatrixXd Geometry::products(const CellGeometry& cell, cases::ElementMass kind) const {
  const Eigen::MatrixXd all = products(cell);
  if (kind == cases::ElementMass::consistent) return all;
  Eigen::VectorXd lumped = all.rowwise().sum();
  if (mean_products_.size() > 0) lumped = all.sum() / all.trace() * all.diagonal();
  return lumped.asDiagonal();
}

Vector3d Geometry::point(int cell, int q) const {
  const auto n = index(nodes_.per_cell);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t a = 0; a < n; ++a)
    sum += shape_values[index(q) * n + a] * nodes_.point[index(nodes_.of_cell[index(cell) * n + a])];
  return sum;
}

} // namespace springproof::fem_reference
