#pragma once

#include "msm/grid/multigrid.hpp"
#include "msm/problem.hpp"

#include <memory>

namespace springproof::msm::grid {

/// A problem on a grid of cells: a body, and its loads as a field (N, 0 on constrained entries).
struct GridProblem {
  Body body;
  Field<double> load;
  /// Displacement (mm) of constrained entries at a load factor, as a field; empty: they stay at rest.
  std::function<Field<double>(double load_factor)> supports{};
};

/// @param problem  on a grid; must outlive what is returned, if its supports move
GridProblem make_grid_problem(const Problem& problem, const std::vector<CellStiffness>& stiffness);

/// The lattice's equations without a matrix: conjugate gradients with the multigrid cycle.
/// Vectors are fields of the layout.
/// @param problem  must outlive the system
std::unique_ptr<SpringSystem> make_grid_system(const GridProblem& problem, int n_threads);

/// Displacement at full load of the same body in coarser cells, interpolated: what Newton's method may start
/// from. Nothing when the coarse body does not carry the load, or there is none.
std::optional<Vector> coarse_guess(const GridProblem& problem, int n_threads);

/// Between fields and one vector (mm or N) per node of the problem's mesh.
Points to_points(const Problem& problem, const Layout& layout, const Field<double>& field);
Field<double> to_field(const Problem& problem, const Layout& layout, const Points& points);

} // namespace springproof::msm::grid
