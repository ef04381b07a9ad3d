#pragma once

#include "fem_reference/element_fields.hpp"
#include "fem_reference/grid/grid_equations.hpp"
#include "mechanics/contact/contact.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/state_on_mesh.hpp"

namespace springproof::fem_reference::grid {

/// A scene as finite elements on a grid, with their states evaluated on the body's own mesh: matrix-vector
/// products and multigrid in place of a factorisation. The grid is cut along z, a slab for each rank; every
/// member function is collective, and the ranks share a state.
class GridBody {
 public:
  /// @param on_mesh  a scene as for Model that is_on_grid(); definition.fem.refine is applied here
  GridBody(const cases::Scene& on_mesh, MPI_Comm communicator, int n_threads = 1);
  /// Another scene on the same mesh, by as many threads of the same ranks.
  GridBody(const cases::Scene& another, const GridBody& like)
      : GridBody(another, like.communicator, like.n_threads_) {}

  const cases::Scene scene; ///< on the body's own mesh
  const MPI_Comm communicator;

  /// Returns what evaluates states on the body's own mesh; it refers to this.
  mechanics::StateOnMesh on_mesh() const;
  /// Rest positions and displacements (mm) of element nodes, 6 numbers each; one rank lists each node.
  std::vector<double> node_displacements(const mechanics::Vector& state) const;

  /// None: bodies with tools are assembled.
  mechanics::Contact* contact() { return nullptr; }
  std::vector<cases::ToolContact> tools(const mechanics::Vector&, double) const { return {}; }

  /// Adds a first guess for a path from rest, by coarser grids.
  void add_guess(mechanics::EquilibriumSettings& settings) const;
  void set_in_motion(const mechanics::EquilibriumSettings& settings);
  /// Whether the linear solver finds Newton's first step from rest to a small load, and the step leaves
  /// almost nothing of the residual. Where stiffnesses differ by six orders and more it does not: the tangent
  /// in single precision has lost the soft ones.
  bool can_leave_rest();

  /// @param state    must outlive the result
  /// @param sharing  its solution's; null: one rank has all
  ElementsInState elements(const mechanics::Vector& state, const cases::Sharing* sharing) const;

 private:
  int n_threads_;
  int cell_factor_; ///< elements along an edge of the body's own cells
  int factor_;      ///< intervals of the grid of nodes along such an edge
  Body body_;
  Places places_;
  Supported supported_;
  std::unique_ptr<QuadraticElements> quadratic_;

  Eigen::Vector3d displacement_at(const Place& at, const mechanics::Vector& state) const;
  template<class Action>
  void for_each_element(const cases::Sharing* sharing, const Action& action) const;

 public:
  GridEquations equations;
};

} // namespace springproof::fem_reference::grid
