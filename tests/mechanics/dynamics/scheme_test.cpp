#include "mechanics/dynamics/scheme.hpp"

#include "tests/mechanics/dynamics/oscillator.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <complex>

using namespace springproof;

using namespace oscillator;

namespace {

/// What a step of 1 s makes of (u, v, a, u before, v before) of an undamped oscillator without load.
Matrix amplification(const cases::TimeScheme& scheme, double omega) {
  const auto c = mechanics::step_coefficients(scheme, 1, 1);
  const auto known = [](const mechanics::KnownMotion& k, const Vector& x) {
    return k.velocity * x[1] + k.acceleration * x[2] + k.displacement_before * (x[3] - x[0]) +
           k.velocity_before * x[4];
  };
  Matrix result(5, 5);
  for (int i = 0; i < 5; ++i) {
    const Vector x = Vector::Unit(5, i);
    // omega² (u0 + d) + mass d - known = 0
    const double d = (known(c.known_acceleration, x) - omega * omega * x[0]) / (c.mass + omega * omega);
    const double v = c.damping * d - known(c.known_velocity, x),
                 a = c.mass * d - known(c.known_acceleration, x);
    result.col(i) << x[0] + d / c.place, x[1] + (v - x[1]) / c.place,
        x[2] + (a - x[2]) / c.place_acceleration, x[0], x[1];
  }
  return result;
}

/// The largest eigenvalue by magnitude.
double spectral_radius(const cases::TimeScheme& scheme, double omega_h) {
  return Eigen::EigenSolver<Matrix>(amplification(scheme, omega_h)).eigenvalues().cwiseAbs().maxCoeff();
}

} // namespace

TEST_CASE("no scheme lets an oscillation grow, whatever the step") {
  for (const auto& scheme : {implicit_euler, newmark, bdf2, generalized_alpha(0), generalized_alpha(0.5),
                             generalized_alpha(1), cases::TimeScheme{cases::Scheme::newmark, 0.3, 0.55, 1}})
    for (double omega_h = 1e-2; omega_h < 1e3; omega_h *= 1.7) {
      INFO(name_of(scheme.scheme) << ", rho " << scheme.rho_infinity << ", omega h " << omega_h);
      CHECK(spectral_radius(scheme, omega_h) <=
            1 + 1e-4); // three eigenvalues that meet lose two thirds of their digits
    }
  CHECK(spectral_radius({cases::Scheme::newmark, 1. / 6, 0.5, 1}, 10) > 2); // stable up to sqrt(12) alone
}

TEST_CASE("what a step leaves of a motion far too fast for it is rho_infinity, nothing, or all") {
  constexpr double fast = 1e8;
  for (const double rho : {0.2, 0.5, 0.9, 1.}) {
    INFO(rho);
    CHECK(spectral_radius(generalized_alpha(rho), fast) ==
          Approx(rho).epsilon(1e-3)); // three eigenvalues meet
  }
  CHECK(spectral_radius(implicit_euler, fast) < 1e-3);
  CHECK(spectral_radius(bdf2, fast) < 1e-3);
  CHECK(spectral_radius(newmark, fast) == Approx(1).epsilon(1e-3));
}

TEST_CASE("a slow oscillation keeps its size by newmark, and by no scheme that damps") {
  constexpr double omega_h = 0.3;
  CHECK(spectral_radius(newmark, omega_h) == Approx(1).epsilon(1e-12));
  CHECK(spectral_radius(generalized_alpha(1), omega_h) == Approx(1).epsilon(1e-12));
  CHECK(spectral_radius(implicit_euler, omega_h) ==
        Approx(1 / std::sqrt(1 + omega_h * omega_h)).epsilon(1e-12));
  CHECK(spectral_radius(bdf2, omega_h) < 1 - 1e-4);
  CHECK(spectral_radius(generalized_alpha(0.5), omega_h) < 1 - 1e-5);
}

TEST_CASE("only the schemes of second order are said to be") {
  CHECK(mechanics::order_of(implicit_euler) == 1);
  CHECK(mechanics::order_of(newmark) == 2);
  CHECK(mechanics::order_of({cases::Scheme::newmark, 0.3025, 0.6, 1}) == 1);
  CHECK(mechanics::order_of(generalized_alpha(0.3)) == 2);
  CHECK(mechanics::order_of(bdf2) == 2);
}

TEST_CASE("the implicit Euler method damps by omega h/2, to first order, and makes swings slower") {
  for (const double omega_h : {1e-3, 0.01, 0.1})
    CHECK(mechanics::swings_in_steps(implicit_euler, omega_h).damping_ratio ==
          Approx(omega_h / 2).epsilon(omega_h * omega_h + 1e-9));
  for (const double omega_h : {0.1, 1., 10., 1000.}) { // the root is 1/(1 - i omega h)
    const auto swings = mechanics::swings_in_steps(implicit_euler, omega_h);
    const double decay = std::log1p(omega_h * omega_h) / (2 * std::atan(omega_h));
    CHECK(swings.damping_ratio == Approx(decay / std::hypot(1, decay)).epsilon(1e-9));
    CHECK(swings.period ==
          Approx(omega_h / std::atan(omega_h)).epsilon(1e-7)); // a small eigenvalue among large entries
  }
}

TEST_CASE("swings in steps of the other schemes have the damping and the period of their closed forms") {
  for (const double omega_h : {0.01, 0.3, 2., 20.}) {
    INFO(omega_h);
    for (const auto& scheme : {newmark, generalized_alpha(1)}) { // tan(angle/2) = omega h/2
      const auto swings = mechanics::swings_in_steps(scheme, omega_h);
      CHECK(std::abs(swings.damping_ratio) < 1e-9);
      CHECK(swings.period == Approx(omega_h / (2 * std::atan(omega_h / 2))).epsilon(1e-9));
    }
    const std::complex<double> i(0, 1);
    const auto root = (2. + std::sqrt(1. + 2. * i * omega_h)) / (3. - 2. * i * omega_h); // bdf2's
    const double decay = -std::log(std::abs(root)) / std::arg(root);
    const auto swings = mechanics::swings_in_steps(bdf2, omega_h);
    CHECK(swings.damping_ratio == Approx(decay / std::hypot(1, decay)).epsilon(1e-6).margin(1e-9));
    CHECK(swings.period == Approx(omega_h / std::arg(root)).epsilon(1e-9));
  }
  // Newmark's with gamma above 1/2: (gamma - 1/2) omega h/2 to first order.
  CHECK(mechanics::swings_in_steps({cases::Scheme::newmark, 0.3025, 0.6, 1}, 0.01).damping_ratio ==
        Approx(0.1 * 0.01 / 2).epsilon(1e-3));
  CHECK(mechanics::swings_in_steps(generalized_alpha(0.5), 1.).damping_ratio > 1e-3);
}
