#pragma once

#include "mechanics/grid/smoother.hpp"
#include "msm/grid/merged_multigrid.hpp"
#include "msm/grid/spring_field.hpp"
#include "msm/grid/transfer.hpp"

#include <Eigen/Cholesky>
#include <deque>

namespace springproof::msm::grid {

/// A body and ever coarser ones: the last has few enough nodes for a dense factorisation, and is no part. All
/// stiffnesses are divided by the power of two that brings the largest of the finest body to 1 to 2.
std::deque<Body> coarsenings(const Body& finest);

/// One over that power of two.
double scale_of(const Body& finest);

/// A body whose stiffnesses are those of another times a factor.
Body scaled(Body body, double factor);

/// What a cycle smooths with in equilibrium: the lowest motions of a body take most of the iterations.
constexpr mechanics::grid::Chebyshev smoother_at_rest{3, 8};
/// And in a step in time, where a few iterations do: half the products (0.6 of a step's time, measured).
constexpr mechanics::grid::Chebyshev smoother_in_motion{2, 4};

/// Approximate inverse, but for a factor, of the clamped tangent, plus a diagonal if there is one: one
/// V-cycle in single precision. Coarse lattices are rediscretised at the sampled displacement, or of bodies
/// with holes or of several stiffnesses a MergedMultigrid; the smoother is Chebyshev's iteration on the block
/// Jacobi method (Adams, Brezina, Hu, Tuminaro 2003), the same before and after, so that the cycle is
/// symmetric. Coarse diagonals are the fine one restricted, as masses are; below a level where the diagonal
/// holds all eigenvalues in the smoother's range the cycle does not go.
class Multigrid {
 public:
  /// @param bodies  must outlive it; on parts of a body every function is collective
  Multigrid(const std::deque<Body>& bodies, int n_threads,
            const mechanics::grid::Chebyshev& smoother = smoother_at_rest);

  /// From the next linearise() on.
  /// @param diagonal  of the finest body, N/mm times scale_of() it; 0 on constrained entries
  void set_diagonal(const Field<double>& diagonal);

  /// Prepares the cycle at a displacement of the finest body, mm.
  void linearise(const Field<double>& displacement);

  /// solution = cycle(right_side), both of the finest body.
  void apply(const Field<double>& right_side, Field<double>& solution);
  /// The same of a right side that leaves single precision in range, near 1 in norm.
  void apply(const Field<float>& right_side, Field<float>& solution);

 private:
  struct Level {
    Level(const Body& of, int n_threads);
    const Body& body;
    SpringField<float> springs;
    Field<float> displacement, inverse_diagonal;
    Field<float> diagonal; ///< besides that of the springs; of no size: none
    Field<float> solution, residual, correction, product;
    Field<float> rough; ///< guess of the mode of the largest eigenvalue
    double largest_eigenvalue = 0;
  };
  mechanics::grid::Chebyshev smoother_;
  std::deque<Level> levels_;
  std::deque<Transfer<float>> transfers_; ///< between levels l and l + 1
  std::optional<MergedMultigrid> merged_; ///< below the first level, in place of all others
  int n_threads_;
  Field<double> linearised_at_;
  bool is_linearised_ = false;
  std::size_t last_ = 0; ///< level that the cycle goes down to
  std::vector<std::ptrdiff_t> coarsest_unknowns_;
  Eigen::MatrixXd coarsest_matrix_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;
  Eigen::VectorXd coarsest_answer_;

  /// product = (tangent + diagonal) direction
  void multiply(const Level& level, const Field<float>& direction, Field<float>& product) const;
  bool needs_no_coarser(const Level& level) const;
  void estimate_largest_eigenvalue(Level& level);
  void factorise_coarsest();
  void correct(Level& level, bool keeps_residual);
  void smooth(Level& level, bool keeps_residual);
  void cycle(std::size_t l);
  void whole_cycle();
};

} // namespace springproof::msm::grid
