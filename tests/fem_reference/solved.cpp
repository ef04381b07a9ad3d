#include "solved.hpp"

#include "fem_reference/model.hpp"
#include "tests/support/largest.hpp"

#include <Eigen/Cholesky>

using namespace springproof;

using namespace fem_reference;
using Eigen::Vector3d;

namespace {

/// On one rank, which has all nodes.
Discretisation& prescribe(const Prescribed& prescribed, Discretisation& d) {
  const auto n = static_cast<std::size_t>(d.nodes.per_cell);
  for (int cell = 0; prescribed.body_force && cell < d.nodes.n_cells; ++cell)
    for (int q = 0; q < d.geometry.n_points; ++q) {
      const Vector3d force =
          d.geometry.of(cell).weights[q] * prescribed.body_force(d.geometry.point(cell, q));
      for (std::size_t a = 0; a < n; ++a)
        for (std::size_t c = 0; c < 3; ++c) {
          const int node = d.nodes.of_cell[static_cast<std::size_t>(cell) * n + a];
          d.load[3 * static_cast<std::size_t>(node) + c] +=
              d.geometry.shape_values[static_cast<std::size_t>(q) * n + a] * force[static_cast<int>(c)];
        }
    }
  for (std::size_t i = 0; prescribed.displacement && i < d.constraints.is_constrained.size(); ++i)
    if (d.constraints.is_constrained[i])
      d.constraints.at_full_load[i] = prescribed.displacement(d.nodes.point[i / 3])[static_cast<int>(i % 3)];
  return d;
}

} // namespace

Eigen::MatrixXd condensed_tangent(const CellResult& cell) {
  const Eigen::MatrixXd all = cell.tangent;
  const Eigen::Index n = cell.internal_slope.cols(), n_vertices = all.cols() - n;
  return all.topLeftCorner(n, n) -
         all.topRightCorner(n, n_vertices) *
             all.bottomRightCorner(n_vertices, n_vertices).ldlt().solve(all.bottomLeftCorner(n_vertices, n));
}

Solved::Solved(const cases::Scene& scene, const Prescribed& prescribed)
    : formulation(make_formulation(scene.definition.fem, scene.definition.material)),
      discretisation(scene, element_type(scene.definition.fem, formulation), MPI_COMM_SELF),
      equations(prescribe(prescribed, discretisation), {formulation}),
      state(mechanics::find_equilibrium(equations, equations.rest(), "test", default_settings()).state) {}

std::vector<Vector3d> Solved::displacement() const {
  std::vector<Vector3d> nodes(discretisation.nodes.point.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) nodes[n] = Eigen::Map<const Vector3d>(state.data() + 3 * n);
  return nodes;
}

double Solved::largest_error(const Field& exact) const {
  const auto u = displacement();
  double largest = 0;
  for (std::size_t n = 0; n < u.size(); ++n)
    largest = larger(largest, (u[n] - exact(discretisation.nodes.point[n])).norm());
  return largest;
}

double Solved::l2_error(const Field& exact) const {
  const auto& d = discretisation;
  const auto u = displacement();
  const auto n = static_cast<std::size_t>(d.nodes.per_cell);
  double squared = 0;
  for (int cell = 0; cell < d.nodes.n_cells; ++cell)
    for (int q = 0; q < d.geometry.n_points; ++q) {
      Vector3d error = -exact(d.geometry.point(cell, q));
      for (std::size_t a = 0; a < n; ++a)
        error += d.geometry.shape_values[static_cast<std::size_t>(q) * n + a] *
                 u[static_cast<std::size_t>(d.nodes.of_cell[static_cast<std::size_t>(cell) * n + a])];
      squared += d.geometry.of(cell).weights[q] * error.squaredNorm();
    }
  return std::sqrt(squared);
}

Vector3d Solved::force_on(const std::function<bool(const Vector3d&)>& selected) const {
  const auto& d = discretisation;
  const auto u = displacement();
  const auto n = static_cast<std::size_t>(d.nodes.per_cell);
  const auto kernel = formulation.make_kernel(d.element);
  Vector3d sum = Vector3d::Zero();
  for (std::size_t cell = 0; cell < static_cast<std::size_t>(d.nodes.n_cells); ++cell) {
    std::vector<double> own;
    for (std::size_t a = 0; a < n; ++a) {
      const Vector3d& node = u[static_cast<std::size_t>(d.nodes.of_cell[cell * n + a])];
      own.insert(own.end(), node.data(), node.data() + 3);
    }
    const double* pressure =
        state.data() + 3 * d.nodes.point.size() + cell * static_cast<std::size_t>(d.element.n_pressure_modes);
    const CellResult& result =
        kernel->evaluate(d.geometry.of(static_cast<int>(cell)), own.data(), pressure, Wanted::stress);
    for (std::size_t a = 0; a < n; ++a)
      if (selected(d.nodes.point[static_cast<std::size_t>(d.nodes.of_cell[cell * n + a])]))
        sum += Vector3d(result.plain_force[a], result.plain_force[n + a], result.plain_force[2 * n + a]);
  }
  return sum;
}
