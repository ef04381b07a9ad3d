#pragma once

#include "mechanics/grid/smoother.hpp"
#include "msm/grid/spring_field.hpp"
#include "msm/grid/transfer.hpp"

#include <Eigen/Cholesky>
#include <deque>

namespace springproof::msm::grid {

/// A body and ever coarser ones: the last has few enough nodes for a dense factorisation, and is no part. All
/// stiffnesses are divided by the power of two that brings the largest of the finest body to 1 to 2.
std::deque<Body> coarsenings(const Body& finest);

/// Approximate inverse, but for a factor, of the clamped tangent: one V-cycle in single precision. Coarse
/// lattices are rediscretised at the sampled displacement; the smoother is Chebyshev's iteration on the block
/// Jacobi method (Adams, Brezina, Hu, Tuminaro 2003), the same before and after, so that the cycle is
/// symmetric.
class Multigrid {
 public:
  /// @param bodies  must outlive it; on parts of a body every function is collective
  Multigrid(const std::deque<Body>& bodies, int n_threads);

  /// Prepares the cycle at a displacement of the finest body, mm.
  void linearise(const Field<double>& displacement);

  /// solution = cycle(right_side), both of the finest body.
  void apply(const Field<double>& right_side, Field<double>& solution);

 private:
  struct Level {
    Level(const Body& of, int n_threads);
    const Body& body;
    SpringField<float> springs;
    Field<float> displacement, inverse_diagonal;
    Field<float> solution, residual, correction, product;
    Field<float> rough; ///< guess of the mode of the largest eigenvalue
    double largest_eigenvalue = 0;
  };
  std::deque<Level> levels_;
  std::deque<Transfer<float>> transfers_; ///< between levels l and l + 1
  int n_threads_;
  Field<double> linearised_at_;
  std::vector<std::ptrdiff_t> coarsest_unknowns_;
  Eigen::LLT<Eigen::MatrixXd> coarsest_;

  void estimate_largest_eigenvalue(Level& level);
  void factorise_coarsest();
  void correct(Level& level, bool keeps_residual);
  void smooth(Level& level, bool keeps_residual);
  void cycle(std::size_t l);
};

} // namespace springproof::msm::grid
