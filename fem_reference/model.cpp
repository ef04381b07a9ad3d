#include "fem_reference/model.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/grid/grid_body.hpp"
#include "fem_reference/grid/on_grid.hpp"
#include "fem_reference/solved_body.hpp"

#include <deal.II/base/mpi.h>

namespace springproof::fem_reference {

namespace {

/// Extracts rows and columns of free unknowns.  @param number  each one's among the free, or -1
Eigen::SparseMatrix<double> on_free_dofs(const LocalMatrix& all, const std::vector<int>& number, int n_free) {
  std::vector<Eigen::Triplet<double>> entries;
  for (Eigen::Index row = 0; row < all.rows(); ++row)
    for (LocalMatrix::InnerIterator entry(all, row); entry; ++entry) {
      const int r = number[cases::index(row)], c = number[cases::index(entry.col())];
      if (r >= 0 && c >= 0) entries.emplace_back(r, c, entry.value());
    }
  Eigen::SparseMatrix<double> free(n_free, n_free);
  free.setFromTriplets(entries.begin(), entries.end());
  return free;
}

} // namespace

/// A model on the grid, until its multigrid proves not to serve, or an assembled one.
struct Model::Implementation {
  MPI_Comm communicator;
  std::optional<SolvedBody<grid::GridBody>> grid{};
  std::optional<SolvedBody<AssembledBody>> assembled{}; ///< takes the grid's place
  bool stays_on_grid = false;

  template<class Action>
  auto with_body(const Action& action) {
    return assembled ? action(*assembled) : action(*grid);
  }

  /// Blames multigrid and not the body for a failed path if multigrid fails the body at rest too, or is known
  /// to. It may be to blame if no load at all was reached: bending a long body of nu = 0.499 is too much for
  /// multigrid, which the first small step from rest does not show. A body that can be factorised is then
  /// solved once more.
  bool is_multigrid_to_blame(const cases::SolveError& error) {
    const cases::Scene& scene = grid->body.scene;
    return grid::bulk_over_shear(scene) > most_incompressible ||
           (error.so_far().load_reached == 0 &&
            takes_factorisation(n_element_nodes(scene), scene.definition.fem)) ||
           !grid->body.can_leave_rest();
  }
};

Model::Model(const cases::Scene& scene, MPI_Comm communicator, Backend backend)
    : implementation_(new Implementation{communicator}) {
  if (backend_of(scene, backend) == Backend::assembled)
    implementation_->assembled.emplace(scene, communicator);
  else
    implementation_->grid.emplace(scene, communicator);
  implementation_->stays_on_grid = backend == Backend::grid;
}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;

cases::Solution Model::solve(const mechanics::EquilibriumSettings& settings) {
  implementation_->with_body([](auto& elements) { elements.back_to_rest(); });
  return solve_again(1, settings);
}

cases::Solution Model::solve_again(double load_factor, const mechanics::EquilibriumSettings& settings) {
  auto& [communicator, grid, assembled, stays_on_grid] = *implementation_;
  if (!assembled) try {
      return grid->solve(load_factor, settings);
    } catch (const cases::SolveError& error) {
      if (stays_on_grid || !implementation_->is_multigrid_to_blame(error)) throw;
      assembled.emplace(grid->body.scene, communicator);
    }
  cases::Solution solution = assembled->solve(load_factor, settings);
  if (grid) solution.message = by_assembled_tangent;
  return solution;
}

cases::Fields Model::fields(const cases::Sharing* sharing) {
  return implementation_->with_body([&](auto& elements) {
    ElementsInState state = elements.body.elements(elements.last, sharing);
    state.tools = elements.tools;
    return fields_of(state, sharing, elements.last_load_factor);
  });
}

std::vector<NodeDisplacement> Model::node_displacements() const {
  const auto here = implementation_->with_body(
      [](const auto& elements) { return elements.body.node_displacements(elements.last); });
  std::vector<NodeDisplacement> nodes;
  for (const std::vector<double>& part :
       dealii::Utilities::MPI::all_gather(implementation_->communicator, here))
    for (const double* at = part.data(); at != part.data() + part.size(); at += 6)
      nodes.push_back({Eigen::Vector3d(at), Eigen::Vector3d(at + 3)});
  return nodes;
}

mechanics::IntegrationSettings default_steps() {
  mechanics::IntegrationSettings settings;
  settings.newton = default_settings();
  return settings;
}

cases::Solution follow(const cases::Scene& scene, const mechanics::IntegrationSettings& settings,
                       Backend backend, MPI_Comm communicator) {
  const bool is_on_grid = backend_of(scene, backend) == Backend::grid;
  if (is_on_grid) {
    SolvedBody<grid::GridBody> elements(scene, communicator);
    try {
      return elements.follow(settings);
    } catch (const cases::SolveError&) {
      if (backend == Backend::grid || !elements.body.equations.linear_solver_failed()) throw;
    }
  }
  cases::Solution solution = SolvedBody<AssembledBody>(scene, communicator).follow(settings);
  if (is_on_grid) solution.message = by_assembled_tangent;
  return solution;
}

mechanics::VibratingBody vibrating_body(const cases::Scene& scene) {
  const AssembledBody body(scene, MPI_COMM_SELF);
  const Discretisation& d = body.discretisation;
  mechanics::VibratingBody result;
  std::vector<int> number, of_dof; // unknowns', and those of displacements alone
  int n_free = 0;
  const std::size_t n = cases::index(d.n_per_node());
  for (std::size_t i = 0; i < n * d.nodes.point.size(); ++i) {
    const bool is_held = d.is_held(i), is_displacement = i % n < 3;
    number.push_back(is_held ? -1 : n_free);
    if (is_displacement) of_dof.push_back(number.back());
    if (is_held) continue;
    ++n_free;
    const int node = d.nodes.mesh_node[i / n];
    const bool is_of_body = is_displacement && node >= 0 && cases::index(node) < scene.mesh.nodes.size();
    result.mesh_dof.push_back(is_of_body ? 3 * node + static_cast<int>(i % n) : -1);
  }
  const cases::Scene refined = cases::refine(scene, scene.definition.fem.refine);
  result.stiffness = on_free_dofs(rest_stiffness(d, body.formulations), number, n_free);
  result.mass = on_free_dofs(make_inertia(refined, d, body.formulations).mass, of_dof, n_free);
  return result;
}

} // namespace springproof::fem_reference
