#pragma once

#include "cases/case/solution.hpp"
#include "fem_reference/backend.hpp"
#include "mechanics/dynamics/time_integrator.hpp"
#include "mechanics/vibrating_body.hpp"

#include <memory>
#include <mpi.h>

namespace springproof::fem_reference {

struct NodeDisplacement {
  Eigen::Vector3d rest, displacement; ///< mm
};

/// A finite-element model of a scene, distributed over the ranks of a communicator: mesh, degrees of freedom,
/// sparsity. Every member function is collective; the ranks share a solution (Solution::sharing). The
/// functions are virtual for callers that this code is loaded by at run time, who cannot be linked to it.
class Model {
 public:
  /// @param scene  the body's scene; definition.fem.refine is applied here
  /// @throws InputError for a combination of material, formulation and element that has no meaning
  Model(const cases::Scene& scene, MPI_Comm communicator, Backend backend = Backend::automatic);
  virtual ~Model();
  Model(Model&&) noexcept;

  /// Static equilibrium under the scene's loads, from rest.
  /// @throws SolveError with the load factor reached when the load cannot be carried
  virtual cases::Solution solve(const mechanics::EquilibriumSettings& settings = default_settings());

  /// Static equilibrium under the scene's loads times a factor, from the equilibrium last found; a linear
  /// body keeps its factorised stiffness.
  /// @throws SolveError as solve(), after which the last equilibrium is as it was
  virtual cases::Solution solve_again(double load_factor,
                                      const mechanics::EquilibriumSettings& settings = default_settings());

  /// Stress, strain, energy and reactions in the equilibrium last found, on the body's own mesh. Collective.
  /// @param sharing  its solution's
  virtual cases::Fields fields(const cases::Sharing* sharing);

  /// Displacements of all element nodes, also between vertices, in the equilibrium last found; in any order.
  virtual std::vector<NodeDisplacement> node_displacements() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The usual limits of a step in time of finite elements: those of a path's load step.
mechanics::IntegrationSettings default_steps();

/// The motion of a scene's finite elements through the time of its [dynamics], over the ranks of a
/// communicator. Collective: they share the end of the motion, and each has the whole trajectory.
/// @param backend  automatic: the grid's where choose_backend() says so, and the assembled one where the
///                 grid's linear solver fails
/// @return the end of the motion, with its trajectory
/// @throws InputError as Model
/// @throws SolveError with the time reached when the motion cannot be followed, or with the load reached when
/// it cannot start in equilibrium
cases::Solution follow(const cases::Scene& scene,
                       const mechanics::IntegrationSettings& settings = default_steps(),
                       Backend backend = Backend::automatic, MPI_Comm communicator = MPI_COMM_SELF);

/// The vibrations of a scene's finite elements about rest, assembled in this process alone.
/// @throws InputError as Model
mechanics::VibratingBody vibrating_body(const cases::Scene& scene);

} // namespace springproof::fem_reference
