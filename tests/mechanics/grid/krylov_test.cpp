#include "mechanics/grid/krylov.hpp"

#include "mechanics/grid/cycle.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof::mechanics;

using grid::Field;

namespace {

constexpr double target = 1e-10;

/// Solves a system with a diagonal matrix and ones on the right.
grid::LinearSolution solve(const Eigen::VectorXd& diagonal) {
  const auto times = [&](const Field<double>& in, Field<double>& out) { out = diagonal.cwiseProduct(in); };
  const auto as_it_is = [](const Field<double>& in, Field<double>& out) { out = in; };
  return grid::conjugate_gradients(
      times, as_it_is, Eigen::VectorXd::Ones(diagonal.size()), target, 100,
      [](const Field<double>& a, const Field<double>& b) { return a.dot(b); }, 1);
}

} // namespace

TEST_CASE("conjugate gradients take as many iterations as a matrix has eigenvalues") {
  Eigen::VectorXd diagonal(40);
  for (int i = 0; i < diagonal.size(); ++i) diagonal[i] = 1 + i % 4; // 1, 2, 3, 4
  const grid::LinearSolution found = solve(diagonal);
  CHECK(found.converged);
  CHECK(found.iterations == 4);
  CHECK((diagonal.cwiseProduct(found.solution) - Eigen::VectorXd::Ones(40)).norm() <= 2 * target);
}

TEST_CASE("conjugate gradients tell of a matrix that is not positive definite") {
  const grid::LinearSolution found = solve(Eigen::Vector3d(1, 2, -4));
  CHECK_FALSE(found.converged);
  CHECK(found.met_negative_curvature);
}

TEST_CASE("Chebyshev's iteration damps its part of the spectrum as its polynomial does") {
  const grid::Chebyshev chebyshev{3, 8};
  const double upper = 4, lower = upper / chebyshev.share;
  // max |p| on [lower, upper], p(0) = 1: 1 / T_3((upper + lower) / (upper - lower))
  const double outside = (upper + lower) / (upper - lower);
  const double bound = 1 / (4 * std::pow(outside, 3) - 3 * outside);
  double largest = 0;
  for (double eigenvalue = lower; eigenvalue <= upper; eigenvalue += upper / 64) {
    float solution = 0, residual = 1, correction = 0;
    grid::smooth(
        chebyshev, upper,
        [&](float keep, float factor) { correction = keep * correction + factor * residual; },
        [&](bool keeps_residual) {
          solution += correction;
          if (keeps_residual) residual -= static_cast<float>(eigenvalue) * correction;
        },
        true);
    CHECK(std::abs(1 - eigenvalue * static_cast<double>(solution)) ==
          Approx(std::abs(residual)).margin(1e-6));
    largest = std::max(largest, static_cast<double>(std::abs(residual)));
  }
  CHECK(largest == Approx(bound).epsilon(1e-5)); // reached at both ends
}
