#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <memory>
#include <mpi.h>

namespace springproof::fem_reference {

struct NodeDisplacement {
  Eigen::Vector3d rest, displacement; ///< mm
};

/// The usual limits of a path of finite elements. Small load steps follow a path that large ones would leave;
/// with Stability::report negative eigenvalues are counted, which may cost a factorisation.
mechanics::EquilibriumSettings default_settings();

enum class Backend {
  automatic, ///< grid where the body is one and the element is known to it, else or if that fails assembled
  assembled, ///< any mesh: assembled tangent; a sparse factorisation, or algebraic multigrid for large bodies
  grid       ///< grids of equal cuboids: geometric multigrid, no factorisation
};

/// What `automatic` means for a scene's body and element.
/// @param n_nodes  of the elements, after fem.refine; the scene's own mesh may be without nodes
Backend choose_backend(const cases::Scene& scene, double n_nodes);

/// Whether the assembled backend factorises a tangent of that many nodes.
bool takes_factorisation(double n_nodes);

/// A finite-element model of a scene, distributed over the ranks of a communicator: mesh, degrees of freedom,
/// sparsity. Every member function is collective; the ranks share a solution (Solution::sharing).
class Model {
 public:
  /// @param scene  the body's scene; definition.fem.refine is applied here
  /// @throws InputError for a combination of material, formulation and element that has no meaning
  Model(const cases::Scene& scene, MPI_Comm communicator, Backend backend = Backend::automatic);
  ~Model();
  Model(Model&&) noexcept;

  /// Static equilibrium under the scene's loads, from rest.
  /// @throws SolveError with the load factor reached when the load cannot be carried
  cases::Solution solve(const mechanics::EquilibriumSettings& settings = default_settings());

  /// Static equilibrium under the scene's loads times a factor, from the equilibrium last found; a linear
  /// body keeps its factorised stiffness.
  /// @throws SolveError as solve(), after which the last equilibrium is as it was
  cases::Solution solve_again(double load_factor,
                              const mechanics::EquilibriumSettings& settings = default_settings());

  /// Stress, strain, energy and reactions in the equilibrium last found, on the body's own mesh. Collective.
  /// @param sharing  of its solution
  cases::Fields fields(const cases::Sharing* sharing);

  /// Of every node of the elements, those between vertices too, in the equilibrium last found; in any order.
  std::vector<NodeDisplacement> node_displacements() const;

 private:
  struct Implementation;
  struct Assembled;
  struct OnGrid;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace springproof::fem_reference
