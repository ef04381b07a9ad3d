#pragma once

#include "fem_reference/element.hpp"
#include "mechanics/field_sums.hpp"

namespace springproof::fem_reference {

/// Where an element lies in its cell of the body's mesh: a cube of the cell's unit cube.
struct ElementPlace {
  std::size_t cell;
  Eigen::Vector3d lower; ///< corner
  double edge;           ///< 1/2 to the number of refinements
};

/// Place of a cell of the body's mesh refined n times: cases::refine() makes cells 8c .. 8c+7 of cell c, the
/// number's last three bits being the octant.
ElementPlace place_of(std::size_t refined_cell, int n_refinements);

/// What one element adds to the fields. Arrays are laid out as in CellKernel::evaluate().
struct ElementState {
  ElementPlace place;
  CellGeometry geometry;
  const double* displacement; ///< mm
  const double* force;        ///< internal, N: CellResult::plain_force
  double energy;              ///< N mm
};

/// Adds elements up to fields on the body's own mesh, refined or not: the forces of the elements' nodes go to
/// the vertices of the body's cell by its trilinear shape functions, so that the sum over a support is the
/// support's force on every mesh, and a node's has a limit under refinement.
class ElementFields {
 public:
  /// @param scene  the scene on the body's own mesh    @param nodes  an element's nodes in its unit cube
  /// @param cells  range that contains the body's cells of all elements to be added
  ElementFields(const cases::Scene& scene, Kinematics kinematics, std::vector<Eigen::Vector3d> nodes,
                const cases::Range& cells);

  void add(const ElementState& element);
  /// Fields of an equilibrium under the scene's loads times a factor: mechanics::fields_of(). Call it once.
  cases::Fields fields(const cases::Sharing* sharing, double load_factor);

 private:
  const cases::Scene& scene_;
  Kinematics kinematics_;
  std::vector<Eigen::Vector3d> nodes_;
  mechanics::FieldSums sums_;
};

/// Norms of the elements' own displacement over the body at rest, of all of its nodes.
class DisplacementNorms {
 public:
  /// @param nodes  an element's nodes in its unit cube
  DisplacementNorms(int degree, const std::vector<Eigen::Vector3d>& nodes);
  /// @param displacement  mm, as in CellKernel::evaluate()
  void add(const CellGeometry& geometry, const double* displacement);
  /// Collective.
  cases::FieldNorms norms(const cases::Sharing* sharing) const;

 private:
  std::vector<double> shape_; ///< N_a at Gauss point q: [q*n_nodes + a]
  double integral_ = 0, volume_ = 0, largest_ = 0;
};

/// Whether a case measures displacement norms that need more than the nodes of the body's mesh.
bool has_own_norms(const cases::Case& definition, int degree);

} // namespace springproof::fem_reference
