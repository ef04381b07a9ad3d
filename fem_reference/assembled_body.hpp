#pragma once

#include "cases/mesh/sharing.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/equations.hpp"

namespace springproof::fem_reference {

/// The case's formulation with each of the scene's materials.
std::vector<Formulation> formulations_of(const cases::Scene& scene);

/// A scene as assembled finite elements, and what their states say of the body's own mesh.
struct AssembledBody {
  /// @param scene  on the body's own mesh; definition.fem.refine is applied here
  /// @throws InputError for a combination of material, formulation and element that has no meaning
  AssembledBody(const cases::Scene& scene, MPI_Comm communicator);

  cases::Scene scene;                    ///< on the body's own mesh
  std::vector<Formulation> formulations; ///< one for each of the scene's materials
  Discretisation discretisation;         ///< of the refined mesh
  EquilibriumEquations equations;

  /// Of this rank's nodes, mm.
  std::vector<cases::Numbered<Eigen::Vector3d>> displacement(const State& state) const;
  /// Deformed volumes that this rank's elements add to the body's cells, mm³.
  std::vector<cases::Numbered<double>> cell_volumes(const State& state);
  /// Of an equilibrium. Collective.  @param sharing  of its solution
  cases::Fields fields(const State& state, const cases::Sharing* sharing, double load_factor);
};

} // namespace springproof::fem_reference
