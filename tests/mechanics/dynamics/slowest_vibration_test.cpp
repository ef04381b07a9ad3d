#include "mechanics/dynamics/slowest_vibration.hpp"

#include "tests/mechanics/dynamics/oscillator.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace oscillator;

namespace {

/// Masses of 1 t in a row on springs of 1 N/mm between them, and of `held` N/mm from the first to a wall.
Body chain(int n, double held) {
  Matrix stiffness = Matrix::Zero(n, n);
  stiffness(0, 0) = held;
  for (int i = 1; i < n; ++i) {
    stiffness(i, i) += 1;
    stiffness(i - 1, i - 1) += 1;
    stiffness(i, i - 1) -= 1;
    stiffness(i - 1, i) -= 1;
  }
  return linear(Matrix::Identity(n, n), stiffness);
}

} // namespace

TEST_CASE("the slowest vibration of a chain is that of its closed form, with its damping", "[verification]") {
  const double pi = std::acos(-1.0);
  for (const int n : {1, 2, 8, 60}) {
    INFO(n);
    Body held = chain(n, 1);
    held.damping = 0.3 * held.mass + 0.05 * held.stiffness(Vector::Zero(n));
    const auto found = mechanics::slowest_vibration(held, Vector::Zero(n), 1000);
    REQUIRE(found);
    const double omega = 2 * std::sin(pi / (2 * (2 * n + 1)));
    CHECK(found->omega == Approx(omega).epsilon(1e-2)); // iterations stop at 5e-3 of omega²
    CHECK(found->damping_ratio == Approx(0.3 / (2 * omega) + 0.05 * omega / 2).epsilon(1e-2));
  }
}

TEST_CASE("motions without stiffness, and slower than the time looked at, are no vibrations",
          "[verification]") {
  const double pi = std::acos(-1.0);
  const auto omega_of = [](Body body, double seconds) {
    const auto found = mechanics::slowest_vibration(body, Vector::Zero(body.mass.rows()), seconds);
    return found ? found->omega : 0;
  };
  CHECK(omega_of(chain(8, 0), 1000) == Approx(2 * std::sin(pi / 16)).epsilon(1e-2));   // it flies
  CHECK(omega_of(chain(8, 1e-10), 10) == Approx(2 * std::sin(pi / 16)).epsilon(1e-2)); // a radian in 3e5 s
  CHECK(omega_of(linear(Matrix::Identity(3, 3), Matrix::Zero(3, 3)), 10) == 0);
  Body fails = chain(3, 1);
  fails.least_mass_factor = 1e9; // the linear solver does
  CHECK(omega_of(fails, 10) == 0);
}
