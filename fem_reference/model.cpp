#include "fem_reference/model.hpp"

#include "cases/case/error.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/grid/on_grid.hpp"
#include "fem_reference/solved_body.hpp"

#include <deal.II/base/mpi.h>

namespace springproof::fem_reference {

namespace {

/// Extracts rows and columns of free degrees of freedom.  @param number  each one's among the free, or -1
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

struct Model::Implementation {
  virtual ~Implementation() = default;
  virtual cases::Solution solve(double load_factor, const mechanics::EquilibriumSettings& settings) = 0;
  virtual void back_to_rest() = 0;
  virtual cases::Fields fields(const cases::Sharing* sharing) = 0;
  virtual std::vector<double> node_displacements() const = 0; ///< this rank's, as from the bodies
};

template<class Body>
struct Model::Of : Model::Implementation, SolvedBody<Body> {
  using Solved = SolvedBody<Body>;
  using Solved::Solved, Solved::body, Solved::last;

  cases::Solution solve(double load_factor, const mechanics::EquilibriumSettings& settings) override {
    cases::Solution solution = Solved::solve(load_factor, settings);
    solution.norms = norms_of(body, last, solution.sharing.get());
    return solution;
  }
  void back_to_rest() override { Solved::back_to_rest(); }
  cases::Fields fields(const cases::Sharing* sharing) override {
    return fields_of(body, last, sharing, Solved::last_load_factor);
  }
  std::vector<double> node_displacements() const override { return body.node_displacements(last); }
};

/// A model on the grid, until its multigrid proves not to serve.
struct Model::OnGrid : Model::Implementation {
  OnGrid(const cases::Scene& scene, MPI_Comm communicator) : grid(scene, communicator) {}
  cases::Solution solve(double load_factor, const mechanics::EquilibriumSettings& settings) override;
  void back_to_rest() override {
    grid.back_to_rest();
    if (assembled) assembled->back_to_rest();
  }
  cases::Fields fields(const cases::Sharing* sharing) override {
    return assembled ? assembled->fields(sharing) : grid.fields(sharing);
  }
  std::vector<double> node_displacements() const override {
    return assembled ? assembled->node_displacements() : grid.node_displacements();
  }

  Of<grid::GridBody> grid;
  std::unique_ptr<Of<AssembledBody>> assembled;
};

/// Blames multigrid and not the body for a failed path if multigrid fails the body at rest too, or is known
/// to. It may be to blame if no load at all was reached: bending a long body of nu = 0.499 is too much for
/// multigrid, which the first small step from rest does not show. A body that can be factorised is then
/// solved once more.
cases::Solution Model::OnGrid::solve(double load_factor, const mechanics::EquilibriumSettings& settings) {
  const cases::Scene& scene = grid.body.scene;
  if (!assembled) try {
      return grid.solve(load_factor, settings);
    } catch (const cases::SolveError& error) {
      const bool may_be_multigrid =
          grid::bulk_over_shear(scene) > most_incompressible ||
          (error.so_far().load_reached == 0 && takes_factorisation(n_element_nodes(scene)));
      if (!may_be_multigrid && grid.body.can_leave_rest()) throw;
      assembled = std::make_unique<Of<AssembledBody>>(scene, grid.body.communicator);
    }
  cases::Solution solution = assembled->solve(load_factor, settings);
  solution.message = by_assembled_tangent;
  return solution;
}

Model::Model(const cases::Scene& scene, MPI_Comm communicator, Backend backend)
    : communicator_(communicator) {
  if (backend_of(scene, backend) == Backend::assembled)
    implementation_ = std::make_unique<Of<AssembledBody>>(scene, communicator);
  else if (backend == Backend::grid)
    implementation_ = std::make_unique<Of<grid::GridBody>>(scene, communicator);
  else
    implementation_ = std::make_unique<OnGrid>(scene, communicator);
}
Model::~Model() = default;
Model::Model(Model&&) noexcept = default;

cases::Solution Model::solve(const mechanics::EquilibriumSettings& settings) {
  implementation_->back_to_rest();
  return implementation_->solve(1, settings);
}

cases::Solution Model::solve_again(double load_factor, const mechanics::EquilibriumSettings& settings) {
  return implementation_->solve(load_factor, settings);
}

cases::Fields Model::fields(const cases::Sharing* sharing) {
  return implementation_->fields(sharing);
}

std::vector<NodeDisplacement> Model::node_displacements() const {
  std::vector<NodeDisplacement> nodes;
  for (const std::vector<double>& part :
       dealii::Utilities::MPI::all_gather(communicator_, implementation_->node_displacements()))
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
  const auto followed = [&](auto& elements) {
    cases::Solution solution = elements.follow(settings);
    solution.norms = norms_of(elements.body, elements.last, solution.sharing.get());
    return solution;
  };
  std::string message;
  if (backend_of(scene, backend) == Backend::grid) {
    SolvedBody<grid::GridBody> elements(scene, communicator);
    try {
      return followed(elements);
    } catch (const cases::SolveError&) {
      if (backend == Backend::grid || !elements.body.equations.linear_solver_failed()) throw;
    }
    message = by_assembled_tangent;
  }
  SolvedBody<AssembledBody> elements(scene, communicator);
  cases::Solution solution = followed(elements);
  solution.message = message;
  return solution;
}

mechanics::VibratingBody vibrating_body(const cases::Scene& scene) {
  const AssembledBody body(scene, MPI_COMM_SELF);
  const Discretisation& d = body.discretisation;
  mechanics::VibratingBody result;
  std::vector<int> number;
  int n_free = 0;
  for (std::size_t i = 0; i < d.constraints.is_constrained.size(); ++i) {
    number.push_back(d.constraints.is_constrained[i] ? -1 : n_free);
    if (d.constraints.is_constrained[i]) continue;
    ++n_free;
    const int node = d.nodes.mesh_node[i / 3];
    const bool is_of_body = node >= 0 && cases::index(node) < scene.mesh.nodes.size();
    result.mesh_dof.push_back(is_of_body ? 3 * node + static_cast<int>(i % 3) : -1);
  }
  const cases::Scene refined = cases::refine(scene, scene.definition.fem.refine);
  result.stiffness = on_free_dofs(rest_stiffness(d, body.formulations), number, n_free);
  result.mass = on_free_dofs(make_inertia(refined, d, body.formulations).mass, number, n_free);
  return result;
}

} // namespace springproof::fem_reference
