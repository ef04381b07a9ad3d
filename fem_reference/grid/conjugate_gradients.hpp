#pragma once

#include "fem_reference/grid/field.hpp"

#include <cmath>

namespace springproof::fem_reference::grid {

struct ConjugateGradients {
  Field<double> solution;
  int iterations = 0;
  bool converged = false;
  bool met_negative_curvature = false; ///< of the operator; then it did not converge
};

/// Preconditioned conjugate gradients for operator * solution = right_side, until the residual is at most
/// `target`. The preconditioner is symmetric but for the rounding of single precision; Polak and Ribiere's
/// formula does not mind.
template<class Operator, class Preconditioner>
ConjugateGradients conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                                       const Field<double>& right_side, double target, int max_iterations,
                                       const Space& space) {
  ConjugateGradients result;
  const std::ptrdiff_t n = right_side.size();
  result.solution.setZero(n);
  if (dot(space, right_side, right_side) <= target * target) {
    result.converged = true;
    return result;
  }
  Field<double> residual = right_side, preconditioned = Field<double>::Zero(n),
                product = Field<double>::Zero(n);
  precondition(residual, preconditioned);
  Field<double> direction = preconditioned;
  double slope = dot(space, residual, preconditioned);
  while (result.iterations < max_iterations) {
    apply(direction, product);
    ++result.iterations;
    const double curvature = dot(space, direction, product);
    result.met_negative_curvature = curvature <= 0;
    if (!(curvature > 0) || !(slope > 0)) return result;
    const double length = slope / curvature;
    add(result.solution, length, direction, space.n_threads);
    add(residual, -length, product, space.n_threads);
    if (dot(space, residual, residual) <= target * target) {
      result.converged = true;
      return result;
    }
    const double crossed = dot(space, residual, preconditioned);
    precondition(residual, preconditioned);
    const double now = dot(space, residual, preconditioned);
    const double keep = (now - crossed) / slope;
    slope = now;
    for_each_piece(n, space.n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length_) {
      direction.segment(first, length_) =
          preconditioned.segment(first, length_) + keep * direction.segment(first, length_);
    });
  }
  return result;
}

} // namespace springproof::fem_reference::grid
