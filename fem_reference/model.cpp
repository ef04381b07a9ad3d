#include "fem_reference/model.hpp"

#include "fem_reference/load_path.hpp"

#include <algorithm>

namespace fem_reference {

namespace {

std::size_t index(int i) {
  return static_cast<std::size_t>(i);
}

/// The case's formulation with each of the scene's materials.
std::vector<Formulation> formulations_of(const cases::Scene& scene) {
  std::vector<Formulation> formulations;
  for (const cases::Material& material : cases::materials_of(scene.definition))
    formulations.push_back(make_formulation(scene.definition.fem, material));
  return formulations;
}

void sum_over_ranks(std::vector<double>& values, MPI_Comm communicator) {
  MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_SUM,
                communicator);
}

} // namespace

struct Model::Implementation {
  Implementation(const cases::Scene& the_scene, MPI_Comm communicator)
      : scene(the_scene), formulations(formulations_of(scene)),
        discretisation(cases::refine(scene, scene.definition.fem.refine),
                       element_type(scene.definition.fem, formulations.front()), {}, communicator),
        equilibrium(discretisation, formulations), solver(discretisation, formulations.front().symmetry) {}

  std::vector<Eigen::Vector3d> body_displacement(const State& state) const;
  std::vector<double> body_cell_volumes(const State& state);

  cases::Scene scene;                    ///< on the body's own mesh
  std::vector<Formulation> formulations; ///< one for each of the scene's materials
  Discretisation discretisation;
  Equilibrium equilibrium;
  LinearSolver solver;
};

/// The nodes of the body's mesh are the first of the refined mesh.
std::vector<Eigen::Vector3d> Model::Implementation::body_displacement(const State& state) const {
  const std::size_t n = scene.mesh.nodes.size();
  std::vector<double> values(3 * n, 0.);
  const PetscScalar* owned = nullptr;
  check(VecGetArrayRead(state.displacement.get(), &owned));
  for (std::size_t node = 0; node < index(discretisation.n_owned_nodes); ++node) {
    const int number = discretisation.mesh_node[node];
    if (number >= 0 && index(number) < n) std::copy_n(owned + 3 * node, 3, values.begin() + 3 * number);
  }
  check(VecRestoreArrayRead(state.displacement.get(), &owned));
  sum_over_ranks(values, discretisation.communicator);
  std::vector<Eigen::Vector3d> displacement(n);
  for (std::size_t node = 0; node < n; ++node)
    displacement[node] = Eigen::Map<const Eigen::Vector3d>(values.data() + 3 * node);
  return displacement;
}

/// Each cell of the body is its 8^refine descendants.
std::vector<double> Model::Implementation::body_cell_volumes(const State& state) {
  std::vector<double> volumes(scene.mesh.cells.size(), 0.);
  const std::vector<double> own = equilibrium.cell_volumes(state);
  const int shift = 3 * scene.definition.fem.refine;
  for (std::size_t cell = 0; cell < own.size(); ++cell)
    volumes[index(discretisation.mesh_cell[cell] >> shift)] += own[cell];
  sum_over_ranks(volumes, discretisation.communicator);
  return volumes;
}

Model::Model(const cases::Scene& scene, MPI_Comm communicator)
    : implementation_(std::make_unique<Implementation>(scene, communicator)) {}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;

cases::Solution Model::solve(double largest_load_step) {
  Implementation& m = *implementation_;
  State state = m.equilibrium.rest();
  const NewtonReport report = carry_load(m.equilibrium, m.solver, state, largest_load_step);
  cases::Solution solution;
  solution.status = cases::Status::converged;
  solution.displacement = m.body_displacement(state);
  solution.cell_volume = m.body_cell_volumes(state);
  solution.unknowns = static_cast<std::size_t>(m.discretisation.n_unknowns);
  solution.residual = report.residual;
  solution.load_reached = 1;
  solution.newton_iterations = report.iterations;
  solution.linear_iterations = report.linear_iterations;
  solution.negative_eigenvalues = m.solver.negative_eigenvalues();
  if (solution.negative_eigenvalues)
    solution.outcome = *solution.negative_eigenvalues == 0 ? cases::Outcome::stable_equilibrium
                                                           : cases::Outcome::unstable_equilibrium;
  for (std::size_t cell = 0; cell < m.scene.mesh.cells.size(); ++cell)
    if (!(cases::smallest_corner_jacobian(cases::cell_vertices(m.scene.mesh, cell, solution.displacement)) >
          0))
      ++solution.inverted_cells;
  return solution;
}

} // namespace fem_reference
