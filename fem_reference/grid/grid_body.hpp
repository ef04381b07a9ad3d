#pragma once

#include "cases/scene/scene.hpp"
#include "fem_reference/element_equations.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"
#include "mechanics/state_on_mesh.hpp"

#include <array>
#include <functional>
#include <memory>
#include <mpi.h>

namespace springproof::fem_reference::grid {

/// A scene as finite elements on a grid, with their states evaluated on the body's own mesh: matrix-vector
/// products and multigrid in place of a factorisation. The grid is cut along z, a slab for each rank; every
/// member function is collective, and the ranks share a state.
struct GridBody {
  /// @param on_mesh  a scene as for Model that is_on_grid(); definition.fem.refine is applied here
  GridBody(const cases::Scene& on_mesh, MPI_Comm communicator, int n_threads = 1);
  /// Another scene on the same mesh, by as many threads of the same ranks.
  GridBody(const cases::Scene& another, const GridBody& like);
  ~GridBody();

  const cases::Scene scene; ///< on the body's own mesh
  const MPI_Comm communicator;
  const int n_threads;
  const int cell_factor; ///< elements along an edge of the body's own cells
  struct Parts;
  const std::unique_ptr<Parts> parts;
  ElementEquations& equations;

  /// Returns what evaluates states on the body's own mesh; it refers to this.
  mechanics::StateOnMesh on_mesh() const;
  /// Rest positions and displacements (mm) of element nodes, 6 numbers each; one rank lists each node.
  std::vector<double> node_displacements(const mechanics::Vector& state) const;

  /// Adds a first guess for a path from rest, by coarser grids.
  void add_guess(mechanics::EquilibriumSettings& settings) const;
  void set_in_motion(const mechanics::EquilibriumSettings& settings);
  /// Whether the linear solver finds Newton's first step from rest to a small load, and the step leaves
  /// almost nothing of the residual. Where stiffnesses differ by six orders and more it does not: the tangent
  /// in single precision has lost the soft ones.
  bool can_leave_rest();

  /// An element in a state. A cell of the body is n_parts elements along each edge.
  struct Element {
    std::size_t cell;        ///< number in the body's own mesh
    std::array<int, 3> part; ///< 0 to n_parts - 1
    int n_parts;
    const std::vector<double>& displacement; ///< mm, [3*a + i], a with x fastest: 8 nodes, or 27
    double pressure;                         ///< MPa; 0 without one of its own
  };
  /// Calls action() for elements, cell by cell. Of the ranks that share a solution, one visits each element.
  /// @param sharing  the solution's; null: one rank has all
  void for_each_element(const mechanics::Vector& state, const cases::Sharing* sharing,
                        const std::function<void(const Element&)>& action) const;
  /// Range of the body's cells that for_each_element() visits.
  cases::Range cells(const cases::Sharing* sharing) const;
};

} // namespace springproof::fem_reference::grid
