#pragma once

#include "fem_reference/laws/formulation.hpp"
#include "mechanics/field_sums.hpp"

namespace springproof::fem_reference {

/// Where an element lies in its cell of the body's mesh: its point x, in its reference cell, at
/// origin + axes x in the cell's.
struct ElementPlace {
  std::size_t cell;
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;
};

/// Place of a cell of the body's mesh refined n times: cases::refine() makes cells 8c .. 8c+7 of cell c, the
/// number's last three bits being the child's.
ElementPlace place_of(cases::CellShape shape, std::size_t refined_cell, int n_refinements);

/// An element in a state. Arrays are laid out as in CellKernel::evaluate().
struct ElementState {
  ElementPlace place;
  CellGeometry geometry;
  const double* displacement; ///< mm
  const double* internal;     ///< its unknowns beside these
};

/// The elements of a body in a state, as its fields and norms are made of them.
struct ElementsInState {
  const cases::Scene& scene;             ///< on the body's own mesh
  std::vector<Formulation> formulations; ///< one for each of its materials
  ElementType type;
  std::vector<Eigen::Vector3d> nodes;                           ///< an element's, in its reference cell
  std::function<Eigen::MatrixXd(const CellGeometry&)> products; ///< integrals of N_a N_b, mm³
  cases::Range cells; ///< contains the body's cells of all elements here
  /// Calls action(element). Of the ranks that share a state, one has each element.
  std::function<void(const std::function<void(const ElementState&)>& action)> for_each;
  std::vector<cases::ToolContact> tools{}; ///< what tools do to the body
};

/// Fields of an equilibrium under the scene's loads times a factor, on the body's own mesh: the forces of the
/// elements' nodes go to the vertices of the body's cell by the cell's shape functions, so that the sum
/// over a support is the support's force on every mesh, and a node's has a limit under refinement.
/// Collective.  @param sharing  the solution's
cases::Fields fields_of(const ElementsInState& elements, const cases::Sharing* sharing, double load_factor);

/// Norms of the elements' own displacement over the body at rest, of all of its nodes. Collective.
cases::FieldNorms displacement_norms(const ElementsInState& elements, const cases::Sharing* sharing);

/// The same if the case measures norms that need more than the nodes of the body's mesh.
std::optional<cases::FieldNorms> norms_of(const ElementsInState& elements, const cases::Sharing* sharing);

} // namespace springproof::fem_reference
