#include "fem_reference/model.hpp"

#include "fem_reference/equations.hpp"

#include <deal.II/base/mpi.h>

namespace springproof::fem_reference {

namespace {

using cases::index;

/// The case's formulation with each of the scene's materials.
std::vector<Formulation> formulations_of(const cases::Scene& scene) {
  std::vector<Formulation> formulations;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    formulations.push_back(make_formulation(scene.definition.fem, material));
  return formulations;
}

void sum_over_ranks(double* values, std::size_t n, MPI_Comm communicator) {
  MPI_Allreduce(MPI_IN_PLACE, values, static_cast<int>(n), MPI_DOUBLE, MPI_SUM, communicator);
}

} // namespace

mechanics::EquilibriumSettings default_settings() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-10;
  settings.smallest_load_step = 1. / 512;
  settings.max_newton_per_step = 14;
  settings.easy_newton_per_step = 6;
  settings.max_convexified_per_step = 0; // the tangent is the exact one
  settings.max_newton_iterations = 300;
  settings.stability = mechanics::Stability::report;
  return settings;
}

struct Model::Implementation {
  Implementation(const cases::Scene& the_scene, MPI_Comm communicator)
      : scene(the_scene), formulations(formulations_of(scene)),
        discretisation(cases::refine(scene, scene.definition.fem.refine),
                       element_type(scene.definition.fem, formulations.front()), {}, communicator),
        equations(discretisation, formulations), last(equations.rest()) {}

  std::vector<Eigen::Vector3d> body_displacement() const;
  std::vector<double> body_cell_volumes();
  cases::Solution solve(double load_factor, mechanics::EquilibriumSettings settings);

  cases::Scene scene;                    ///< on the body's own mesh
  std::vector<Formulation> formulations; ///< one for each of the scene's materials
  Discretisation discretisation;
  EquilibriumEquations equations;
  State last;                  ///< the equilibrium last found
  double last_load_factor = 0; ///< its load; 0: at rest
};

/// The nodes of the body's mesh are the first of the refined mesh.
std::vector<Eigen::Vector3d> Model::Implementation::body_displacement() const {
  std::vector<Eigen::Vector3d> displacement(scene.mesh.nodes.size(), Eigen::Vector3d::Zero());
  for (int node = 0; node < discretisation.nodes.n_owned; ++node) {
    const int number = discretisation.nodes.mesh_node[index(node)];
    if (number >= 0 && index(number) < displacement.size())
      displacement[index(number)] = last.segment<3>(3 * node);
  }
  sum_over_ranks(displacement.front().data(), 3 * displacement.size(), discretisation.communicator);
  return displacement;
}

/// Each cell of the body is its 8^refine descendants.
std::vector<double> Model::Implementation::body_cell_volumes() {
  std::vector<double> volumes(scene.mesh.cells.size(), 0.);
  const std::vector<double> own = equations.cell_volumes(last);
  const int shift = 3 * scene.definition.fem.refine;
  for (std::size_t cell = 0; cell < own.size(); ++cell)
    volumes[index(discretisation.nodes.mesh_cell[cell] >> shift)] += own[cell];
  sum_over_ranks(volumes.data(), volumes.size(), discretisation.communicator);
  return volumes;
}

Model::Model(const cases::Scene& scene, MPI_Comm communicator)
    : implementation_(std::make_unique<Implementation>(scene, communicator)) {}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;

cases::Solution Model::solve(const mechanics::EquilibriumSettings& settings) {
  Implementation& m = *implementation_;
  m.last = m.equations.rest();
  m.last_load_factor = 0;
  return m.solve(1, settings);
}

cases::Solution Model::solve_again(double load_factor, const mechanics::EquilibriumSettings& settings) {
  return implementation_->solve(load_factor, settings);
}

cases::Solution Model::Implementation::solve(double load_factor, mechanics::EquilibriumSettings settings) {
  settings.from = last_load_factor;
  settings.to = load_factor;
  const auto equilibrium = mechanics::find_equilibrium(equations, last, "finite elements", settings);
  last = equilibrium.state;
  last_load_factor = load_factor;
  cases::Solution solution = mechanics::to_solution(equilibrium);
  solution.displacement = body_displacement();
  solution.cell_volume = body_cell_volumes();
  solution.unknowns = static_cast<std::size_t>(discretisation.constraints.n_unknowns);
  if (settings.stability != mechanics::Stability::ignore)
    solution.negative_eigenvalues = equations.negative_eigenvalues();
  for (std::size_t cell = 0; cell < scene.mesh.cells.size(); ++cell)
    if (!(cases::smallest_corner_jacobian(cases::cell_vertices(scene.mesh, cell, solution.displacement)) > 0))
      ++solution.inverted_cells;
  return solution;
}

std::vector<NodeDisplacement> Model::node_displacements() const {
  const Discretisation& d = implementation_->discretisation;
  std::vector<double> own;
  const double* displacement = implementation_->last.data();
  for (std::size_t node = 0; node < index(d.nodes.n_owned); ++node, displacement += 3) {
    own.insert(own.end(), d.nodes.point[node].begin(), d.nodes.point[node].end());
    own.insert(own.end(), displacement, displacement + 3);
  }
  std::vector<NodeDisplacement> nodes;
  for (const std::vector<double>& part : dealii::Utilities::MPI::all_gather(d.communicator, own))
    for (const double* at = part.data(); at != part.data() + part.size(); at += 6)
      nodes.push_back({Eigen::Vector3d(at), Eigen::Vector3d(at + 3)});
  return nodes;
}

} // namespace springproof::fem_reference
