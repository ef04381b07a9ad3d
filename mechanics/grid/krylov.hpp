#pragma once

#include "mechanics/grid/field.hpp"
#include "mechanics/interruption.hpp"

#include <Eigen/QR>
#include <cmath>
#include <utility>
#include <vector>

namespace springproof::mechanics::grid {

/// What an iterative linear solver found.
template<class Real>
struct LinearSolutionIn {
  Field<Real> solution;
  int iterations = 0;
  bool converged = false;
  bool met_negative_curvature = false; ///< or zero curvature; then it did not converge
  Field<Real> direction{};             ///< the direction with that curvature
};
using LinearSolution = LinearSolutionIn<double>;

/// Work fields of conjugate gradients, kept from one solution to the next to save allocations.
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

/// Flexible GMRES (Saad 1993), for what conjugate gradients cannot solve: an operator that is not symmetric,
/// or of either sign. It keeps two vectors an iteration until it restarts.
template<class Operator, class Preconditioner, class Dot>
LinearSolution generalised_minimal_residual(const Operator& apply, const Preconditioner& precondition,
                                            const Field<double>& right_side, double target,
                                            int max_iterations, int restart, const Dot& dot, int n_threads) {
  LinearSolution result;
  const auto norm_of = [&](const Field<double>& v) { return std::sqrt(dot(v, v)); };
  const std::ptrdiff_t n = right_side.size();
  result.solution.setZero(n);
  Field<double> residual = right_side;
  double norm = norm_of(residual);
  while (!(norm <= target) && result.iterations < max_iterations) {
    std::vector<Field<double>> basis{residual / norm}, images; // images: preconditioned
    Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(restart + 1, restart);
    Eigen::VectorXd weights;
    for (int j = 0; j < restart && result.iterations < max_iterations; ++j) {
      check_interruption();
      ++result.iterations;
      images.push_back(Field<double>::Zero(n));
      precondition(basis.back(), images.back());
      Field<double> next = Field<double>::Zero(n);
      apply(images.back(), next);
      for (int i = 0; i <= j; ++i) {
        const auto& v = basis[static_cast<std::size_t>(i)];
        hessenberg(i, j) = dot(v, next);
        add(next, -hessenberg(i, j), v, n_threads);
      }
      const double length = hessenberg(j + 1, j) = norm_of(next);
      Eigen::VectorXd first = Eigen::VectorXd::Zero(j + 2);
      first[0] = norm;
      const auto small = hessenberg.topLeftCorner(j + 2, j + 1);
      weights = small.colPivHouseholderQr().solve(first);
      result.converged = (first - small * weights).norm() <= target;
      if (result.converged || !(length > 0)) break;
      basis.push_back(next / length);
    }
    for (Eigen::Index j = 0; j < weights.size(); ++j)
      add(result.solution, weights[j], images[static_cast<std::size_t>(j)], n_threads);
    if (result.converged) return result;
    apply(result.solution, residual);
    residual = right_side - residual;
    const double before = std::exchange(norm, norm_of(residual));
    const double cycles_left = std::log(target / norm) / std::log(norm / before);
    if (!(norm < before && cycles_left * restart <= max_iterations - result.iterations))
      break; // at this rate it would not get there
  }
  result.converged = norm <= target;
  return result;
}

} // namespace springproof::mechanics::grid
