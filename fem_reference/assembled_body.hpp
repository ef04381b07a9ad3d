#pragma once

#include "cases/mesh/sharing.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/equations.hpp"
#include "fem_reference/grid/grid_body.hpp"
#include "mechanics/state_on_mesh.hpp"

namespace springproof::fem_reference {

/// The case's formulation with each of the scene's materials.
std::vector<Formulation> formulations_of(const cases::Scene& scene);

/// A scene as assembled finite elements, with their states evaluated on the body's own mesh. The member
/// functions are named like those of grid::GridBody.
struct AssembledBody {
  /// @param on_mesh  the scene on the body's own mesh; definition.fem.refine is applied here
  /// @throws InputError for a combination of material, formulation and element that has no meaning
  AssembledBody(const cases::Scene& on_mesh, MPI_Comm communicator);
  AssembledBody(const cases::Scene& another, const AssembledBody& like)
      : AssembledBody(another, like.discretisation.communicator) {}

  cases::Scene scene;                    ///< on the body's own mesh
  std::vector<Formulation> formulations; ///< one for each of the scene's materials
  Discretisation discretisation;         ///< the refined mesh's
  EquilibriumEquations equations;

  mechanics::StateOnMesh on_mesh();
  std::vector<double> node_displacements(const State& state) const;
  void add_guess(mechanics::EquilibriumSettings&) const {}
  void set_in_motion(const mechanics::EquilibriumSettings&);
};

/// Norms of a state, if the case measures norms that need more than the body's nodes. Collective.
std::optional<cases::FieldNorms> norms_of(AssembledBody& body, const State& state,
                                          const cases::Sharing* sharing);
std::optional<cases::FieldNorms> norms_of(const grid::GridBody& body, const State& state,
                                          const cases::Sharing* sharing);

/// Fields of an equilibrium at a load factor. Collective.  @param sharing  the solution's
cases::Fields fields_of(AssembledBody& body, const State& state, const cases::Sharing* sharing,
                        double load_factor);
cases::Fields fields_of(const grid::GridBody& body, const State& state, const cases::Sharing* sharing,
                        double load_factor);

} // namespace springproof::fem_reference
