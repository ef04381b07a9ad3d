#include "mechanics/dynamics/scheme.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <limits>

namespace springproof::mechanics {

namespace {

/// v1 = (w - u0)/h, a1 = (v1 - v0)/h.
StepCoefficients implicit_euler(double h) {
  StepCoefficients c{1 / (h * h), 1 / h, {}, {}};
  c.known_acceleration.velocity = 1 / h;
  return c;
}

/// M a_(n+1-alpha_m) + C v_(n+1-alpha_f) + f_int(u_(n+1-alpha_f)) = F(t_(n+1-alpha_f)), where x_(n+1-alpha)
/// is (1 - alpha) x1 + alpha x0, and Newmark's formulas
///   u1 = u0 + h v0 + h² ((1/2 - beta) a0 + beta a1),  v1 = v0 + h ((1 - gamma) a0 + gamma a1).
StepCoefficients newmark(double h, double beta, double gamma, double alpha_m, double alpha_f) {
  const double by_acceleration = (1 - alpha_m) / (beta * h), by_velocity = gamma / beta;
  StepCoefficients c{by_acceleration / ((1 - alpha_f) * h), by_velocity / h, {}, {}};
  c.known_acceleration.velocity = by_acceleration;
  c.known_acceleration.acceleration = (1 - alpha_m) * (1 / (2 * beta) - 1) - alpha_m;
  c.known_velocity.velocity = (1 - alpha_f) * by_velocity - 1;
  c.known_velocity.acceleration = -(1 - alpha_f) * h * (1 - by_velocity / 2);
  c.place = 1 - alpha_f;
  c.place_acceleration = 1 - alpha_m;
  return c;
}

/// x1' = ((1 + 2r)/(1 + r) x1 - (1 + r) x0 + r²/(1 + r) x_before)/h with r = h/h_before, of u and of v.
StepCoefficients bdf2(double h, double h_before) {
  const double r = h / h_before;
  const double now = (1 + 2 * r) / ((1 + r) * h), before = r * r / ((1 + r) * h);
  StepCoefficients c{now * now, now, {}, {}};
  c.known_velocity.displacement_before = -before;
  c.known_acceleration.displacement_before = -now * before;
  c.known_acceleration.velocity = (1 + r) / h;
  c.known_acceleration.velocity_before = -before;
  return c;
}

} // namespace

StepCoefficients step_coefficients(const cases::TimeScheme& scheme, double step,
                                   std::optional<double> step_before) {
  switch (scheme.scheme) {
  case cases::Scheme::implicit_euler:
    break;
  case cases::Scheme::newmark:
    return newmark(step, scheme.beta, scheme.gamma, 0, 0);
  case cases::Scheme::generalized_alpha: {
    const double rho = scheme.rho_infinity;
    const double alpha_m = (2 * rho - 1) / (rho + 1), alpha_f = rho / (rho + 1);
    const double half = 0.5 * (1 - alpha_m + alpha_f);
    return newmark(step, half * half, 0.5 - alpha_m + alpha_f, alpha_m, alpha_f);
  }
  case cases::Scheme::bdf2:
    if (step_before) return bdf2(step, *step_before);
    break;
  }
  return implicit_euler(step);
}

bool needs_acceleration(cases::Scheme scheme) {
  return scheme == cases::Scheme::newmark || scheme == cases::Scheme::generalized_alpha;
}

int order_of(const cases::TimeScheme& scheme) {
  const bool is_damped_newmark = scheme.scheme == cases::Scheme::newmark && scheme.gamma != 0.5;
  return scheme.scheme == cases::Scheme::implicit_euler || is_damped_newmark ? 1 : 2;
}

SwingsInSteps swings_in_steps(const cases::TimeScheme& scheme, double omega_h) {
  // State: u, h v, h² a, then u and h v of the step before; the unit of time is h.
  const StepCoefficients c = step_coefficients(scheme, 1, 1);
  Eigen::Matrix<double, 5, 5> amplification = Eigen::Matrix<double, 5, 5>::Zero();
  for (int column = 0; column < 5; ++column) {
    Eigen::Matrix<double, 5, 1> from = Eigen::Matrix<double, 5, 1>::Unit(column);
    const double u = from[0], v = from[1], a = from[2], back = from[3] - u, v_before = from[4];
    const auto of = [&](const KnownMotion& known) {
      return known.velocity * v + known.acceleration * a + known.displacement_before * back +
             known.velocity_before * v_before;
    };
    const double stiffness = omega_h * omega_h;
    const double way = (of(c.known_acceleration) - stiffness * u) / (stiffness + c.mass); // w - u0
    amplification.col(column) << u + way / c.place,
        v + (c.damping * way - of(c.known_velocity) - v) / c.place,
        a + (c.mass * way - of(c.known_acceleration) - a) / c.place_acceleration, u, v;
  }
  // Spurious roots are smaller, or real.
  std::complex<double> principal = 0;
  for (const std::complex<double>& root : amplification.eigenvalues())
    if (root.imag() > 1e-9 && std::abs(root) > std::abs(principal)) principal = root;
  if (principal == 0.) return {1, std::numeric_limits<double>::infinity()};
  constexpr double rounding = 1e-12;
  const double angle = std::arg(principal), of_size = -std::log(std::abs(principal));
  const double decay = of_size > rounding ? of_size / angle : 0;
  return {decay / std::hypot(1, decay), omega_h / angle};
}

} // namespace springproof::mechanics
