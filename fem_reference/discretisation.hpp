#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element.hpp"
#include "fem_reference/petsc.hpp"

#include <functional>
#include <memory>
#include <mpi.h>
#include <vector>

namespace dealii::PETScWrappers::MPI {
class SparseMatrix;
}

namespace springproof::fem_reference {

/// What verification needs beyond a case: a body force and displacements that are not zero where the scene is
/// fixed.
struct Prescribed {
  std::function<Eigen::Vector3d(const Eigen::Vector3d& rest_point)> body_force; ///< N/mm³ at rest; none: zero
  std::function<Eigen::Vector3d(const Eigen::Vector3d& rest_point)>
      displacement; ///< mm, on fixed components; none: zero
};

/// One rank's share of the mesh, its degrees of freedom and the sparsity of the tangent: deal.II's work,
/// handed over as plain arrays. "Local node" k is an owned node for k < n_owned_nodes and a ghost after; its
/// three degrees of freedom are 3*k + component, as in a vector of PETSc with ghosts.
class Discretisation {
 public:
  /// @param scene  already refined: every node of its mesh keeps its number
  Discretisation(const cases::Scene& scene, const ElementType& element, const Prescribed& prescribed,
                 MPI_Comm communicator);
  ~Discretisation();
  Discretisation(const Discretisation&) = delete;
  Discretisation& operator=(const Discretisation&) = delete;

  MPI_Comm communicator;
  ElementType element;
  int n_cells = 0; ///< owned by this rank
  int nodes_per_cell = 0;
  int points_per_cell = 0;
  int n_owned_nodes = 0;
  int first_owned_node = 0;
  long n_unknowns = 0; ///< free degrees of freedom of all ranks

  std::vector<PetscInt> ghost_nodes; ///< their global numbers
  std::vector<int> cell_nodes;       ///< local nodes, nodes_per_cell for each cell
  std::vector<int> mesh_cell;        ///< number of each cell in the scene's mesh
  std::vector<int> material_of_cell; ///< in the scene's materials; empty when there is but one
  std::vector<int> mesh_node;        ///< number of each local node in the scene's mesh, -1 where it has none
  std::vector<char> is_fixed;        ///< per local degree of freedom
  std::vector<double> prescribed;    ///< mm at full load, per local degree of freedom; 0 where free or moved
  std::vector<std::pair<int, cases::Moved>> moved; ///< local nodes that the scene moves, and how
  std::vector<Eigen::Vector3d> node_point;         ///< rest position of each local node, mm
  std::vector<double> load; ///< N per owned degree of freedom: point forces, tractions, torques, body force
  std::vector<double> shape_values; ///< N_a at point q: [q*nodes_per_cell + a]
  Mat tangent = nullptr;            ///< assembled by others

  /// Where a load factor asks the fixed degrees of freedom to be: mm, one per local degree of freedom.
  void prescribe(double load_factor, std::vector<double>& displacement) const;
  CellGeometry geometry(int cell) const;
  /// Rest position of a quadrature point, mm.
  Eigen::Vector3d quadrature_point(int cell, int point) const;
  /// A ghosted vector of displacements or forces, zero.
  Vector make_vector() const;

 private:
  friend struct DiscretisationBuilder;
  std::vector<double> gradients_, weights_, modes_;
  std::unique_ptr<dealii::PETScWrappers::MPI::SparseMatrix> matrix_;
};

} // namespace springproof::fem_reference
