#include "mechanics/grid/lowest_mode.hpp"

#include "mechanics/dense.hpp"
#include "mechanics/grid/field.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <utility>

namespace springproof::mechanics::grid {

namespace {

constexpr int max_iterations = 100; // healthy lattices take 30

void scale(Vector& v, double factor, int n_threads) {
  for_each_piece(v.size(), n_threads,
                 [&](std::ptrdiff_t first, std::ptrdiff_t n) { v.segment(first, n) *= factor; });
}

} // namespace

/// Rayleigh-Ritz on the vector, its preconditioned residual and the last step. Images under the operator are
/// combined like the vectors, so that each iteration needs one.
std::optional<NonlinearProblem::Mode> lowest_mode(const ModeProblem& problem, const Vector& start) {
  const auto& [product, precondition, dot, n_threads, settled] = problem;
  using Columns = std::array<Vector, 3>; // the vector, its preconditioned residual, the last step
  Columns basis, image;
  for (std::size_t c = 0; c < 3; ++c) basis[c] = image[c] = Vector::Zero(start.size());
  const auto to_unit = [&problem](const Vector& v) { return 1 / std::sqrt(problem.dot(v, v)); };
  const auto examine = [&](std::size_t c, const Vector& right_side) {
    problem.precondition(right_side, basis[c]);
    scale(basis[c], to_unit(basis[c]), problem.n_threads);
    problem.product(basis[c], image[c]);
  };
  examine(0, start); // rich in low modes
  double eigenvalue = dot(basis[0], image[0]);
  int n = 2;
  for (int iteration = 0; iteration < max_iterations; ++iteration, n = 3) {
    Vector residual = image[0];
    add(residual, -eigenvalue, basis[0], n_threads);
    examine(1, residual);
    const auto products = [&](const Columns& left, const Columns& right) {
      Eigen::MatrixXd all(n, n); // symmetric, both of them
      for (int r = 0; r < n; ++r)
        for (int c = 0; c <= r; ++c)
          all(r, c) = all(c, r) =
              problem.dot(left[static_cast<std::size_t>(r)], right[static_cast<std::size_t>(c)]);
      return all;
    };
    const Eigen::MatrixXd gram = products(basis, basis), small = products(basis, image);
    const Eigen::LLT<Eigen::MatrixXd> factor(gram);
    if (factor.info() != Eigen::Success || !(factor.matrixL().toDenseMatrix().diagonal().minCoeff() > 1e-7))
      break; // nothing new in the residual
    const Eigen::MatrixXd left = factor.matrixL().solve(small);
    const Eigen::MatrixXd reduced = factor.matrixL().solve(left.transpose());
    const Spectrum ritz = spectrum(reduced);
    const Eigen::VectorXd weights = factor.matrixU().solve(ritz.vectors.col(0));
    const double before = std::exchange(eigenvalue, ritz.values[0]);
    for (Columns* columns : {&basis, &image}) {
      auto& [now, residual_part, step] = *columns;
      scale(step, n == 3 ? weights[2] : 0, n_threads);
      add(step, weights[1], residual_part, n_threads);
      scale(now, weights[0], n_threads);
      add(now, 1.0, step, n_threads);
    }
    for (const std::size_t c : {std::size_t{0}, std::size_t{2}}) {
      const double factor_to_unit = to_unit(basis[c]);
      for (Columns* columns : {&basis, &image}) scale((*columns)[c], factor_to_unit, n_threads);
    }
    if (iteration > 2 && before - eigenvalue <= settled * std::abs(eigenvalue)) break;
  }
  if (!std::isfinite(eigenvalue)) return std::nullopt;
  return NonlinearProblem::Mode{eigenvalue, std::move(basis[0])};
}

} // namespace springproof::mechanics::grid
