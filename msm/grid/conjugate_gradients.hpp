#pragma once

#include "msm/grid/field.hpp"

#include <cmath>

namespace springproof::msm::grid {

struct ConjugateGradients {
  Field<double> solution;
  int iterations = 0;
  bool converged = false;
  bool met_negative_curvature = false; ///< of the operator, or none; then it did not converge
};

/// Preconditioned conjugate gradients for operator * solution = right_side, until the residual is at most
/// `forcing` of the right side. The preconditioner is symmetric but for the rounding of single precision;
/// Polak and Ribiere's formula does not mind.
template<class Operator, class Preconditioner>
ConjugateGradients conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                                       const Field<double>& right_side, double forcing, int max_iterations,
                                       int n_threads) {
  ConjugateGradients result;
  result.solution.setZero(right_side.size());
  Field<double> residual = right_side, preconditioned(right_side.size()), product, direction;
  product.setZero(right_side.size());
  precondition(residual, preconditioned);
  direction = preconditioned;
  double slope = dot(residual, preconditioned, n_threads);
  const double target = forcing * std::sqrt(dot(right_side, right_side, n_threads));
  while (result.iterations < max_iterations) {
    apply(direction, product);
    ++result.iterations;
    const double curvature = dot(direction, product, n_threads);
    result.met_negative_curvature = curvature <= 0;
    if (!(curvature > 0) || !(slope > 0)) return result;
    const double length = slope / curvature;
    add(result.solution, length, direction, n_threads);
    add(residual, -length, product, n_threads);
    if (std::sqrt(dot(residual, residual, n_threads)) <= target) {
      result.converged = true;
      return result;
    }
    const double crossed = dot(residual, preconditioned, n_threads);
    precondition(residual, preconditioned);
    const double now = dot(residual, preconditioned, n_threads);
    const double keep = (now - crossed) / slope;
    slope = now;
    for_each_piece(direction.size(), n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t n) {
      direction.segment(first, n) = preconditioned.segment(first, n) + keep * direction.segment(first, n);
    });
  }
  return result;
}

} // namespace springproof::msm::grid
