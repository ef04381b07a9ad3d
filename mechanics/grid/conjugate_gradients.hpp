#pragma once

#include "mechanics/grid/field.hpp"
#include "mechanics/interruption.hpp"

#include <utility>

namespace springproof::mechanics::grid {

/// What an iterative linear solver found.
template<class Real>
struct LinearSolutionIn {
  Field<Real> solution;
  int iterations = 0;
  bool converged = false;
  bool met_negative_curvature = false; ///< of the operator, or none; then it did not converge
  Field<Real> direction{};             ///< that has met it
};
using LinearSolution = LinearSolutionIn<double>;

/// Fields of conjugate gradients, kept from one solution to the next: nothing is allocated then.
template<class Real>
struct KeptFields {
  Field<Real> residual, preconditioned, product, direction;
};

/// Preconditioned conjugate gradients for operator * solution = right_side, until the residual is at most
/// `target`. The preconditioner is symmetric but for the rounding of single precision; Polak and Ribiere's
/// formula does not mind.
/// @param apply, precondition  (in, out)
/// @param dot                  (a, b), over the nodes of the whole grid, in double precision
template<class Real, class Operator, class Preconditioner, class Dot>
void conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                         const Field<Real>& right_side, double target, int max_iterations, const Dot& dot,
                         int n_threads, KeptFields<Real>& kept, LinearSolutionIn<Real>& result) {
  const std::ptrdiff_t n = right_side.size();
  result.iterations = 0;
  result.met_negative_curvature = false;
  result.solution.setZero(n);
  result.converged = dot(right_side, right_side) <= target * target;
  if (result.converged) return;
  // Lambdas capture these, not bindings (clang 14).
  Field<Real>&residual = kept.residual, &preconditioned = kept.preconditioned, &product = kept.product,
  &direction = kept.direction;
  residual = right_side;
  for (Field<Real>* field : {&preconditioned, &product})
    if (field->size() != n) field->setZero(n);
  precondition(residual, preconditioned);
  direction = preconditioned;
  double slope = dot(residual, preconditioned);
  while (result.iterations < max_iterations) {
    check_interruption();
    apply(direction, product);
    ++result.iterations;
    const double curvature = dot(direction, product);
    result.met_negative_curvature = curvature <= 0;
    if (result.met_negative_curvature) result.direction = direction;
    if (!(curvature > 0) || !(slope > 0)) return;
    const double length = slope / curvature;
    add(result.solution, static_cast<Real>(length), direction, n_threads);
    add(residual, static_cast<Real>(-length), product, n_threads);
    result.converged = dot(residual, residual) <= target * target;
    if (result.converged) return;
    const double crossed = dot(residual, preconditioned);
    precondition(residual, preconditioned);
    const double now = dot(residual, preconditioned), keep = (now - crossed) / slope;
    slope = now;
    for_each_piece(n, n_threads, [&](std::ptrdiff_t first, std::ptrdiff_t length_) {
      scale_and_add(direction.data() + first, static_cast<Real>(keep), preconditioned.data() + first,
                    length_);
    });
  }
}

template<class Operator, class Preconditioner, class Dot>
LinearSolution conjugate_gradients(const Operator& apply, const Preconditioner& precondition,
                                   const Field<double>& right_side, double target, int max_iterations,
                                   const Dot& dot, int n_threads) {
  KeptFields<double> kept;
  LinearSolution result;
  conjugate_gradients(apply, precondition, right_side, target, max_iterations, dot, n_threads, kept, result);
  return result;
}

} // namespace springproof::mechanics::grid
