#pragma once

#include "fem_reference/grid/field.hpp"
#include "mechanics/grid/conjugate_gradients.hpp"

#include <Eigen/QR>
#include <cmath>
#include <utility>
#include <vector>

namespace springproof::fem_reference::grid {

/// Flexible GMRES (Saad 1993), for what conjugate gradients cannot solve: an operator that is not symmetric,
/// or of either sign. It keeps two vectors an iteration until it restarts.
template<class Operator, class Preconditioner>
mechanics::grid::LinearSolution
generalised_minimal_residual(const Operator& apply, const Preconditioner& precondition,
                             const Field<double>& right_side, double target, int max_iterations, int restart,
                             const Space& space) {
  mechanics::grid::LinearSolution result;
  const std::ptrdiff_t n = right_side.size();
  result.solution.setZero(n);
  Field<double> residual = right_side;
  double norm = grid::norm(space, residual);
  while (!(norm <= target) && result.iterations < max_iterations) {
    std::vector<Field<double>> basis{residual / norm}, images; // images: preconditioned
    Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(restart + 1, restart);
    Eigen::VectorXd weights;
    for (int j = 0; j < restart && result.iterations < max_iterations; ++j) {
      mechanics::check_interruption();
      ++result.iterations;
      images.push_back(Field<double>::Zero(n));
      precondition(basis.back(), images.back());
      Field<double> next = Field<double>::Zero(n);
      apply(images.back(), next);
      for (int i = 0; i <= j; ++i) {
        const auto& v = basis[static_cast<std::size_t>(i)];
        hessenberg(i, j) = dot(space, v, next);
        add(next, -hessenberg(i, j), v, space.n_threads);
      }
      const double length = hessenberg(j + 1, j) = grid::norm(space, next);
      Eigen::VectorXd first = Eigen::VectorXd::Zero(j + 2);
      first[0] = norm;
      const auto small = hessenberg.topLeftCorner(j + 2, j + 1);
      weights = small.colPivHouseholderQr().solve(first);
      result.converged = (first - small * weights).norm() <= target;
      if (result.converged || !(length > 0)) break;
      basis.push_back(next / length);
    }
    for (Eigen::Index j = 0; j < weights.size(); ++j)
      add(result.solution, weights[j], images[static_cast<std::size_t>(j)], space.n_threads);
    if (result.converged) return result;
    apply(result.solution, residual);
    residual = right_side - residual;
    const double before = std::exchange(norm, grid::norm(space, residual));
    const double cycles_left = std::log(target / norm) / std::log(norm / before);
    if (!(norm < before && cycles_left * restart <= max_iterations - result.iterations))
      break; // at this rate it would not get there
  }
  result.converged = norm <= target;
  return result;
}

} // namespace springproof::fem_reference::grid
