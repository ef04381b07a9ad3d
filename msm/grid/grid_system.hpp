#pragma once

#include "msm/grid/spring_levels.hpp"
#include "msm/problem.hpp"

#include <memory>

namespace springproof::msm::grid {

/// A problem on a grid of cells: a body, and its loads as a field (N, 0 on constrained entries).
struct GridProblem {
  Body body;
  Field<double> load;
  /// Displacement (mm) of constrained entries at a load factor, as a field that is kept until the next call;
  /// empty: they stay at rest.
  std::function<const Field<double>&(double load_factor)> supports{};
  std::size_t n_unknowns = 0; ///< number in the whole grid, on all ranks
};

/// This rank's part of a whole body (collective), or the whole of it, which every rank then solves by itself.
using DealOut = std::function<Body(Body whole)>;

/// @param problem   has a grid; must outlive what is returned, if its supports move
/// @param deal_out  empty: the body stays whole
GridProblem make_grid_problem(const Problem& problem, const std::vector<CellStiffness>& stiffness,
                              const DealOut& deal_out = {});

/// The lattice's equations without a matrix: conjugate gradients with the multigrid cycle.
/// Vectors are fields of the layout. On a part of a body everything is collective.
class GridSystem : public SpringSystem {
 public:
  virtual const SpringField<double>& springs() const = 0;
};

/// @param problem  must outlive the system
std::unique_ptr<GridSystem> make_grid_system(const GridProblem& problem, int n_threads);

/// Displacement at full load of the same body in coarser cells, interpolated: what Newton's method may start
/// from. Nothing when the coarse body does not carry the load, or there is none.
std::optional<Vector> coarse_guess(const GridProblem& problem, int n_threads);

/// Converts between fields and one vector (mm or N) per node of the problem's mesh.
/// @param sharing  the ranks that get the points together; null: a body that is whole here, and all points
Points to_points(const Problem& problem, const Body& body, const Field<double>& field,
                 const cases::Sharing* sharing = nullptr);
Field<double> to_field(const Problem& problem, const Body& body, const Points& points);

} // namespace springproof::msm::grid
