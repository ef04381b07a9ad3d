#pragma once

#include "cases/scene.hpp"
#include "cases/solution.hpp"

#include <memory>
#include <mpi.h>

namespace fem_reference {

/// A finite-element model of a scene, distributed over the ranks of a communicator: mesh, degrees of freedom,
/// sparsity. Every member function is collective; every rank gets the whole answer.
class Model {
 public:
  /// @param scene  the body's scene; definition.fem.refine is applied here
  /// @throws InputError for a combination of material, formulation and element that has no meaning
  Model(const cases::Scene& scene, MPI_Comm communicator);
  ~Model();
  Model(Model&&) noexcept;

  /// Static equilibrium under the scene's loads, from rest.
  /// @param largest_load_step  of the full load; small steps follow a path that a large one would leave
  /// @throws SolveError with the load factor reached when the load cannot be carried
  cases::Solution solve(double largest_load_step = 1);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace fem_reference
