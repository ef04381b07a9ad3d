#pragma once

#include "cases/mesh/sharing.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/equations.hpp"
#include "fem_reference/grid/grid_model.hpp"
#include "mechanics/state_on_mesh.hpp"

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

  /// Refers to this.
  mechanics::StateOnMesh on_mesh();
  /// When the case measures norms that the body's nodes do not tell. Collective.
  std::optional<cases::FieldNorms> norms(const State& state, const cases::Sharing* sharing);
  /// Of an equilibrium. Collective.  @param sharing  of its solution
  cases::Fields fields(const State& state, const cases::Sharing* sharing, double load_factor);
};

/// The same of the elements on a grid, in the state last found.
std::optional<cases::FieldNorms> norms_of(const grid::GridModel& model, const cases::Sharing* sharing);

} // namespace springproof::fem_reference
