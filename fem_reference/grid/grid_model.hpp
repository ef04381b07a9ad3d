#pragma once

#include "cases/case/solution.hpp"
#include "cases/mesh/sharing.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/dynamics/follow_motion.hpp"

#include <array>
#include <functional>
#include <memory>
#include <mpi.h>

namespace springproof::fem_reference::grid {

/// Finite elements of a scene on a grid: matrix-vector products and multigrid in place of a factorisation.
/// The grid is cut along z, a slab for each rank; every member function is collective, and the ranks share a
/// solution.
class GridModel {
 public:
  /// @param scene  as of Model, is_on_grid(); definition.fem.refine is applied here
  GridModel(const cases::Scene& scene, MPI_Comm communicator, int n_threads);
  ~GridModel();

  const cases::Scene& scene() const;
  /// As of Model.
  cases::Solution solve(double load_factor, const mechanics::EquilibriumSettings& settings);
  /// The motion of a scene with [dynamics], on one rank.
  /// @param settings  an equilibrium that it starts in is found with those of Newton's method
  /// @throws SolveError as fem_reference::follow()
  cases::Solution follow(const mechanics::IntegrationSettings& settings);
  /// Whether the linear solver found no solution when it was last asked for one.
  bool linear_solver_failed() const;
  void back_to_rest();
  /// Whether the linear solver finds Newton's first step from rest to a small load, and the step leaves
  /// almost nothing of the residual. Where stiffnesses differ by six orders and more it does not: the tangent
  /// in single precision has lost the soft ones.
  bool can_leave_rest();
  struct NodeValue {
    Eigen::Vector3d rest, displacement; ///< mm
  };
  std::vector<NodeValue> node_displacements() const;

  /// An element in the equilibrium last found. A cell of the body is n_parts elements along each edge.
  struct Element {
    std::size_t cell;        ///< of the body's own mesh
    std::array<int, 3> part; ///< 0 to n_parts - 1
    int n_parts;
    const std::vector<double>& displacement; ///< mm, [3*a + i], a with x fastest: 8 nodes, or 27
    double pressure;                         ///< MPa; 0 without one of its own
  };
  /// Calls action() for elements, cell by cell: over the ranks that share an answer for each element once.
  /// @param sharing  of the solution; null: one rank has all
  void for_each_element(const cases::Sharing* sharing,
                        const std::function<void(const Element&)>& action) const;
  /// That hold the cells of these elements.
  cases::Range cells(const cases::Sharing* sharing) const;
  double load_factor() const; ///< of the equilibrium last found

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace springproof::fem_reference::grid
