#pragma once

#include "cases/case/solution.hpp"
#include "cases/scene/scene.hpp"
#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <memory>
#include <mpi.h>

namespace springproof::fem_reference::grid {

/// Whether a scene's body is a grid of cells and its element one of those that the kernels know.
bool is_on_grid(const cases::Scene& scene);

/// The largest ratio of a material's bulk modulus to its shear modulus.
double bulk_over_shear(const cases::Scene& scene);

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
  void back_to_rest();
  /// Whether the linear solver finds Newton's first step from rest to a small load, and the step leaves
  /// almost nothing of the residual. Where stiffnesses differ by six orders and more it does not: the tangent
  /// in single precision has lost the soft ones.
  bool can_leave_rest();
  struct NodeValue {
    Eigen::Vector3d rest, displacement; ///< mm
  };
  std::vector<NodeValue> node_displacements() const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

} // namespace springproof::fem_reference::grid
