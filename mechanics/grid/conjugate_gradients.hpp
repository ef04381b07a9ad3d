#pragma once

#include "mechanics/grid/field.hpp"

#include <utility>

namespace springproof::mechanics::grid {

/// What an iterative linear solver found.
struct LinearSolution {
  Field<double> solution;
  int iterations = 0;
  bool converged = false;
  bool met_negative_curvature = false; ///< of the operator, or none; then it did not converge
  Field<double> direction{};           ///< that has met it
};

/// Preconditioned conjugate gradients for operator * solution = right_side, until the residual is at most
/// `target`. The preconditioner is symmetric but for the rounding of single precision; Polak and Ribiere's
/// formula does not mind.
/// @param apply, precondition  (in, out)
/// @param dot                  (a, b), over the nodes of the whole grid
template<class Operator, class Preconditioner, class Dot>
LinearSolution conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                                   const Field<double>& right_side, double target, int max_iterations,
                                   const Dot& dot, int n_threads) {
  LinearSolution result;
  const std::ptrdiff_t n = right_side.size();
  result.solution.setZero(n);
  result.converged = dot(right_side, right_side) <= target * target;
  if (result.converged) return result;
  Field<double> residual = right_side, preconditioned = Field<double>::Zero(n),
                product = Field<double>::Zero(n);
  precondition(residual, preconditioned);
  Field<double> direction = preconditioned;
  double slope = dot(residual, preconditioned);
  while (result.iterations < max_iterations) {
    apply(direction, product);
    ++result.iterations;
    const double curvature = dot(direction, product);
    result.met_negative_curvature = curvature <= 0;
    if (result.met_negative_curvature) result.direction = std::move(direction);
    if (!(curvature > 0) || !(slope > 0)) return result;
    const double length = slope / curvature;
    add(result.solution, length, direction, n_threads);
    add(residual, -length, product, n_threads);
    result.converged = dot(residual, residual) <= target * target;
    if (result.converged) return result;
    const double crossed = dot(residual, preconditioned);
    precondition(residual, preconditioned);
    const double now = dot(residual, preconditioned), keep = (now - crossed) / slope;
    slope = now;
    for_each_piece(n, n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length_) {
      direction.segment(first, length_) =
          preconditioned.segment(first, length_) + keep * direction.segment(first, length_);
    });
  }
  return result;
}

} // namespace springproof::mechanics::grid
