#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element.hpp"
#include "mechanics/petsc/handles.hpp"

#include <vector>

namespace springproof::fem_reference {

using mechanics::petsc::check;
using mechanics::petsc::get;
using mechanics::petsc::Matrix;
using mechanics::petsc::ReadEntries;
using mechanics::petsc::Vector;
using mechanics::petsc::WriteEntries;

struct Space;

/// The nodes of one rank's cells under local numbers, the owned before the ghosts. The three degrees of
/// freedom of local node k are 3*k + component, as in a vector of PETSc with ghosts. Vertices come first in a
/// cell of tetrahedra.
struct Nodes {
  Nodes(const Space& space, const cases::Scene& scene);

  int n_owned = 0;
  int n_cells = 0; ///< owned by this rank
  int per_cell = 0;
  std::vector<PetscInt> global;       ///< number of each local node among all ranks'
  std::vector<int> of_cell;           ///< local nodes, per_cell for each cell
  std::vector<int> mesh_cell;         ///< number of each cell in the scene's mesh
  std::vector<int> mesh_node;         ///< number of each local node in the scene's mesh, -1 where it has none
  std::vector<Eigen::Vector3d> point; ///< rest position of each local node, mm
  std::vector<std::vector<int>> between; ///< for each node of a cell: the cell's vertices whose mean it is

  /// The nodes of a cell in its reference cell.
  std::vector<Eigen::Vector3d> in_reference_cell;

  /// A vector of displacements or forces with ghosts, zero.
  /// @param n  entries for each node
  Vector make_vector(MPI_Comm communicator, int n = 3) const;
};

/// Shape functions, gradients, weights and pressure modes at the quadrature points of a rank's cells at rest.
class Geometry {
 public:
  Geometry(const Space& space, const Nodes& nodes, const ElementType& element);

  int n_points = 0;                 ///< per cell
  std::vector<double> shape_values; ///< N_a at point q: [q*n_nodes + a]

  CellGeometry of(int cell) const;
  /// Integrals of N_a N_b over a cell at rest, mm³; exact for straight tetrahedra, whose points are too few.
  Eigen::MatrixXd products(const CellGeometry& cell) const;
  /// The same, or lumped. The sums of rows of a hexahedron are then on the diagonal. Those of a quadratic
  /// tetrahedron are negative at its vertices: it has its diagonal instead, scaled to its volume (Hinton, Rock
  /// and Zienkiewicz 1976), which is the same at degree 1.
  Eigen::MatrixXd products(const CellGeometry& cell, cases::ElementMass kind) const;
  /// Rest position of a quadrature point, mm.
  Eigen::Vector3d point(int cell, int q) const;

 private:
  void add_pressure_modes(int cell);
  void add_vertex_modes(const Space& space);

  const Nodes& nodes_;
  int n_modes_, n_bubbles_;
  Eigen::MatrixXd mean_products_; ///< a tetrahedron's, over its volume
  std::vector<double> gradients_, weights_, modes_;
};

} // namespace springproof::fem_reference
