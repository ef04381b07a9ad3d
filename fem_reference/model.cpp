#include "fem_reference/model.hpp"

#include "fem_reference/assembled_body.hpp"
#include "fem_reference/cuboid.hpp"
#include "fem_reference/grid/grid_model.hpp"
#include "fem_reference/grid/on_grid.hpp"
#include "mechanics/equilibrium/turns.hpp"

#include <algorithm>
#include <cmath>
#include <deal.II/base/mpi.h>

namespace springproof::fem_reference {

using cases::index;

struct Model::Implementation {
  virtual ~Implementation() = default;
  virtual cases::Solution solve(double load_factor, mechanics::EquilibriumSettings settings) = 0;
  virtual void back_to_rest() = 0;
  virtual cases::Fields fields(const cases::Sharing* sharing) = 0;
  virtual std::vector<NodeDisplacement> node_displacements() const = 0;
};

struct Model::Assembled : Model::Implementation {
  Assembled(const cases::Scene& scene, MPI_Comm communicator)
      : body(scene, communicator), last(body.equations.rest()) {}

  cases::Solution solve(double load_factor, mechanics::EquilibriumSettings settings) override;
  void back_to_rest() override {
    last = body.equations.rest();
    last_load_factor = 0;
  }
  cases::Fields fields(const cases::Sharing* sharing) override;
  std::vector<NodeDisplacement> node_displacements() const override;

  AssembledBody body;
  State last;                  ///< the equilibrium last found
  double last_load_factor = 0; ///< its load; 0: at rest
};

cases::Fields Model::Assembled::fields(const cases::Sharing* sharing) {
  return body.fields(last, sharing, last_load_factor);
}

struct Model::OnGrid : Model::Implementation {
  OnGrid(const cases::Scene& scene, MPI_Comm the_communicator, bool may_assemble)
      : communicator(the_communicator), may_assemble_instead(may_assemble), model(scene, communicator, 1) {}
  cases::Solution solve(double load_factor, mechanics::EquilibriumSettings settings) override;
  void back_to_rest() override {
    model.back_to_rest();
    if (assembled) assembled->back_to_rest();
  }
  cases::Fields fields(const cases::Sharing* sharing) override;
  std::vector<NodeDisplacement> node_displacements() const override {
    if (assembled) return assembled->node_displacements();
    std::vector<NodeDisplacement> nodes;
    for (const auto& [rest, displacement] : model.node_displacements()) nodes.push_back({rest, displacement});
    return nodes;
  }

  MPI_Comm communicator;
  bool may_assemble_instead;
  grid::GridModel model;
  std::unique_ptr<Assembled> assembled; ///< once the grid's multigrid was found not to serve
};

/// By the same kernels as the assembled backend's, one element at a time.
cases::Fields Model::OnGrid::fields(const cases::Sharing* sharing) {
  if (assembled) return assembled->fields(sharing);
  const cases::Scene& scene = model.scene();
  const std::vector<Formulation> formulations = formulations_of(scene);
  const ElementType type = element_type(scene.definition.fem, formulations.front());
  const Cuboid cuboid(type, scene.mesh.grid->spacing / (1 << scene.definition.fem.refine));
  const CellGeometry geometry = cuboid.geometry();
  std::vector<std::unique_ptr<CellKernel>> kernels;
  for (const Formulation& formulation : formulations) kernels.push_back(formulation.make_kernel(type));
  ElementFields sums(scene, formulations.front().kinematics, cuboid.nodes(), model.cells(sharing));
  model.for_each_element(sharing, [&](const grid::GridModel::Element& element) {
    CellKernel& kernel = *kernels[index(cases::material_of(scene, element.cell))];
    const double* displacement = element.displacement.data();
    const CellResult& result = kernel.evaluate(geometry, displacement, &element.pressure, Wanted::stress);
    const double edge = 1. / element.n_parts;
    const Eigen::Vector3d lower = edge * Eigen::Vector3d(element.part[0], element.part[1], element.part[2]);
    sums.add({{element.cell, lower, edge},
              geometry,
              displacement,
              result.plain_force.data(),
              kernel.energy(geometry, displacement, &element.pressure)});
  });
  return sums.fields(sharing, model.load_factor());
}

/// Where the path fails, and multigrid fails the body at rest too or is known to, the body is not to blame.
/// Nor may it be where no load at all was reached: bending a long body of nu = 0.499 is too much for
/// multigrid, which its first small step from rest does not show. Bodies that can be factorised are asked
/// once more.
cases::Solution Model::OnGrid::solve(double load_factor, mechanics::EquilibriumSettings settings) {
  if (!assembled) try {
      cases::Solution solution = model.solve(load_factor, settings);
      solution.norms = norms_of(model, solution.sharing.get());
      return solution;
    } catch (const cases::SolveError& error) {
      const bool may_be_multigrid =
          grid::bulk_over_shear(model.scene()) > most_incompressible ||
          (error.so_far().load_reached == 0 && takes_factorisation(n_element_nodes(model.scene())));
      if (!may_assemble_instead || (!may_be_multigrid && model.can_leave_rest())) throw;
      assembled = std::make_unique<Assembled>(model.scene(), communicator);
    }
  cases::Solution solution = assembled->solve(load_factor, settings);
  solution.message = by_assembled_tangent;
  return solution;
}

Model::Model(const cases::Scene& scene, MPI_Comm communicator, Backend backend) {
  const bool may_assemble_instead = backend == Backend::automatic;
  backend = backend_of(scene, backend);
  if (backend == Backend::grid)
    implementation_ = std::make_unique<OnGrid>(scene, communicator, may_assemble_instead);
  else
    implementation_ = std::make_unique<Assembled>(scene, communicator);
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

cases::Solution Model::Assembled::solve(double load_factor, mechanics::EquilibriumSettings settings) {
  const cases::Scene& scene = body.scene;
  settings.from = last_load_factor;
  settings.to = load_factor;
  settings = mechanics::in_small_turns(cases::largest_turn(scene.definition),
                                       cases::least_load_steps(scene.definition), std::move(settings));
  const auto equilibrium = mechanics::find_equilibrium(body.equations, last, "finite elements", settings);
  last = equilibrium.state;
  last_load_factor = load_factor;
  cases::Solution solution = mechanics::to_solution(equilibrium);
  body.on_mesh().add_to(solution, last);
  solution.norms = body.norms(last, solution.sharing.get());
  if (settings.stability != mechanics::Stability::ignore)
    solution.negative_eigenvalues = body.equations.negative_eigenvalues();
  return solution;
}

cases::Fields Model::fields(const cases::Sharing* sharing) {
  return implementation_->fields(sharing);
}

std::vector<NodeDisplacement> Model::node_displacements() const {
  return implementation_->node_displacements();
}

std::vector<NodeDisplacement> Model::Assembled::node_displacements() const {
  const Discretisation& d = body.discretisation;
  std::vector<double> own;
  const double* displacement = last.data();
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
