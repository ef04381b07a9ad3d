#pragma once

#include "cases/mesh/sharing.hpp"
#include "fem_reference/element_fields.hpp"
#include "fem_reference/equations.hpp"
#include "mechanics/state_on_mesh.hpp"

namespace springproof::fem_reference {

/// The elements of a state of the equations of a scene, refined as its definition says.
/// @param scene  the one on the body's own mesh; all must outlive the result, as must the state
ElementsInState elements_of(const cases::Scene& scene, const std::vector<Formulation>& formulations,
                            const Discretisation& discretisation, EquilibriumEquations& equations,
                            const State& state);

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
  /// @param state  must outlive the result
  ElementsInState elements(const State& state, const cases::Sharing*) {
    return elements_of(scene, formulations, discretisation, equations, state);
  }
  void add_guess(mechanics::EquilibriumSettings&) const {}
  mechanics::Contact* contact() { return equations.contact(); }
  /// What the scene's tools do to the body in a state, with the forces on the nodes of the body's own mesh.
  std::vector<cases::ToolContact> tools(const State& state, double load_factor);
  void set_in_motion(const mechanics::EquilibriumSettings&);
};

} // namespace springproof::fem_reference
