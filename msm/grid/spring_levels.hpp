#pragma once

#include "mechanics/grid/cycle.hpp"
#include "msm/grid/spring_field.hpp"

#include <deque>
#include <vector>

namespace springproof::msm::grid {

/// A body whose stiffnesses are those of another times a factor.
Body scaled(Body body, double factor);

/// What a cycle smooths with in equilibrium: the lowest motions of a body take most of the iterations.
constexpr mechanics::grid::Chebyshev smoother_at_rest{3, 8};
/// The same in a step in time, where a few iterations do: half the products (0.6 of a step's time, measured).
constexpr mechanics::grid::Chebyshev smoother_in_motion{2, 4};

/// A stiffness added at a node of a field: to its x, y and z, which are `size of an array` apart.
struct NodeBlock {
  std::ptrdiff_t x;      ///< entry of the node's x
  Eigen::Matrix3f block; ///< symmetric, >= 0; 0 on constrained components
};

/// product += blocks * direction
inline void add_blocks(const std::vector<NodeBlock>& blocks, std::ptrdiff_t size_of_array,
                       const Field<float>& direction, Field<float>& product) {
  for (const auto& [x, block] : blocks) {
    const std::ptrdiff_t y = x + size_of_array, z = y + size_of_array;
    const Eigen::Vector3f added = block * Eigen::Vector3f(direction[x], direction[y], direction[z]);
    product[x] += added[0];
    product[y] += added[1];
    product[z] += added[2];
  }
}

/// Approximate inverse, but for a factor, of the clamped tangent, plus a diagonal if there is one: a
/// multigrid cycle. Coarse lattices are rediscretised at the sampled displacement, down to few enough nodes
/// for a dense factorisation; for bodies with gaps or several stiffnesses they are merged cells
/// (merged_cells.hpp). Coarse diagonals are the fine one restricted, as masses are; the cycle ends at a
/// level where the diagonal holds all eigenvalues in the smoother's range.
class SpringLevels {
 public:
  /// @param finest  every function is collective if it is a part of a body
  SpringLevels(const Body& finest, int n_threads,
               const mechanics::grid::Chebyshev& smoother = smoother_at_rest);

  /// What all stiffnesses are multiplied by: one over the power of two near the largest.
  double scale() const { return scale_; }
  int n_levels() const { return static_cast<int>(cycle_.levels.size()); }

  using Operator = std::function<void(const Field<float>& direction, Field<float>& product)>;
  /// Sets the added diagonal from the next linearise() on.
  /// @param diagonal  N/mm times scale(), on the finest body; 0 on constrained entries
  /// @param joined    adds what consistent masses have beyond the lumped ones of the diagonal; empty:
  /// nothing.
  ///                  The finest level has it where the masses are no small part of a node's diagonal.
  void set_diagonal(const Field<double>& diagonal, Operator joined = {});

  /// Sets stiffnesses of single nodes, for a cycle that is prepared too: largest eigenvalues, relative to the
  /// diagonal that has them, hold with any. Coarse levels have them restricted, as
  /// masses are. Not for a body that is a part, and merged cells have them on the finest level alone.
  /// @param blocks  N/mm times scale(), of the finest body
  void set_blocks(std::vector<NodeBlock> blocks);

  /// Prepares the cycle at a displacement of the finest body, mm.
  void linearise(const Field<double>& displacement);

  /// solution = cycle(right_side), both of the finest body.
  void apply(const Field<double>& right_side, Field<double>& solution);
  /// The same for a right side with a norm near 1, which keeps single precision in range.
  void apply(const Field<float>& right_side, Field<float>& solution) { cycle_.apply(right_side, solution); }

 private:
  class SpringLevel;
  int n_threads_;
  double scale_;
  std::deque<Body> bodies_;
  mechanics::grid::Cycle cycle_;
  std::vector<SpringLevel*> rediscretised_; ///< the cycle's levels that are lattices
  Field<double> linearised_at_;
  bool is_linearised_ = false;
};

} // namespace springproof::msm::grid
