#include "fem_reference/inertia.hpp"

#include "cases/scene/loads.hpp"

namespace springproof::fem_reference {

namespace {

using cases::index;
using Triplets = std::vector<Eigen::Triplet<double>>;

/// Returns a function of a cell, its tangent at rest; degree of freedom i*n_nodes + a is component i of node
/// a, and with i = 3 its pressure.
auto rest_stiffness_of_cells(const Discretisation& d, const std::vector<Formulation>& formulations) {
  return [&d, kernels = kernels_of(formulations, d.element),
          displacement = std::vector<double>(3 * index(d.nodes.per_cell)),
          internal = std::vector<double>(index(d.element.n_internal()))](int cell) -> const RowMajorMatrix& {
    const auto& material = d.material_of_cell;
    return kernels[material.empty() ? 0 : index(material[index(cell)])]
        ->evaluate(d.geometry.of(cell), displacement.data(), internal.data(), Wanted::stress_and_tangent)
        .tangent;
  };
}

/// Adds a factor times a cell's tangent at rest.
void add_stiffness(const Discretisation& d, int cell, const RowMajorMatrix& tangent, double factor,
                   Triplets& entries) {
  const int n = d.nodes.per_cell, n_per_node = d.n_per_node();
  const int* node = d.nodes.of_cell.data() + cell * n;
  for (int row = 0; row < tangent.rows(); ++row)
    for (int column = 0; column < tangent.cols(); ++column)
      entries.emplace_back(n_per_node * node[row % n] + row / n, n_per_node * node[column % n] + column / n,
                           factor * tangent(row, column));
}

LocalMatrix matrix_of(const Triplets& entries, std::size_t n) {
  LocalMatrix matrix(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n));
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

} // namespace

Inertia make_inertia(const cases::Scene& scene, const Discretisation& d,
                     const std::vector<Formulation>& formulations) {
  const int n = d.nodes.per_cell;
  const auto stiffness = rest_stiffness_of_cells(d, formulations);
  Triplets mass, damping;
  for (int cell = 0; cell < d.nodes.n_cells; ++cell) {
    const auto dynamics = cases::dynamics_of(scene, index(d.nodes.mesh_cell[index(cell)]));
    const int* node = d.nodes.of_cell.data() + cell * n;
    const auto add = [&](Triplets& to, int a, int b, int component, double value) {
      if (value != 0) to.emplace_back(3 * node[a] + component, 3 * node[b] + component, value);
    };
    const Eigen::MatrixXd of_nodes =
        dynamics.density * d.geometry.products(d.geometry.of(cell), scene.definition.fem.mass);
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int i = 0; i < 3; ++i) {
          add(mass, a, b, i, of_nodes(a, b));
          add(damping, a, b, i, dynamics.mass_damping * of_nodes(a, b));
        }
    if (dynamics.stiffness_damping > 0)
      add_stiffness(d, cell, stiffness(cell), dynamics.stiffness_damping, damping);
  }
  const cases::NodeMasses added = cases::added_masses(scene);
  for (int node = 0; node < d.nodes.n_owned; ++node) {
    const double of_node = cases::mass_of(added, d.nodes.mesh_node[index(node)]);
    for (int i = 0; i < 3 && of_node > 0; ++i) mass.emplace_back(3 * node + i, 3 * node + i, of_node);
  }
  const std::size_t n_dofs = d.constraints.is_constrained.size();
  return {matrix_of(mass, n_dofs), matrix_of(damping, n_dofs)};
}

LocalMatrix rest_stiffness(const Discretisation& d, const std::vector<Formulation>& formulations) {
  const auto stiffness = rest_stiffness_of_cells(d, formulations);
  Triplets entries;
  for (int cell = 0; cell < d.nodes.n_cells; ++cell) add_stiffness(d, cell, stiffness(cell), 1, entries);
  return matrix_of(entries, index(d.n_per_node()) * d.nodes.point.size());
}

} // namespace springproof::fem_reference
