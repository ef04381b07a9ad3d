#include "mechanics/dynamics/time_integrator.hpp"

#include "cases/case/error.hpp"
#include "tests/mechanics/dynamics/oscillator.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

using namespace springproof;

using namespace oscillator;
using mechanics::TimeIntegrator;

namespace {

const double pi = std::acos(-1.0);

/// Newton's method until rounding is left, for errors of the schemes alone.
mechanics::IntegrationSettings exact_steps() {
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-12;
  return settings;
}

Vector pair_of(double first, double second) {
  Vector result(2);
  result << first, second;
  return result;
}

/// Two stiffening springs with masses that are coupled, damped, and loaded so that they move as said.
struct Manufactured {
  Body body = oscillator::body(rows(2, 0.5, 0.5, 1));

  Manufactured() {
    body.damping << 0.3, -0.1, -0.1, 0.2;
    const Matrix springs = rows(5, -2, -2, 3);
    body.force = [=](const Vector& u) { return Vector(springs * u + Vector(u.array().cube())); };
    body.stiffness = [=](const Vector& u) {
      return Matrix(springs + Matrix((3 * u.array().square()).matrix().asDiagonal()));
    };
    body.load = [mass = body.mass, damping = body.damping, force = body.force](double t) {
      return Vector(mass * acceleration(t) + damping * velocity(t) + force(displacement(t)));
    };
  }
  static Vector displacement(double t) { return pair_of(1 - std::cos(2 * t), 0.5 * std::cos(3 * t + 0.4)); }
  static Vector velocity(double t) { return pair_of(2 * std::sin(2 * t), -1.5 * std::sin(3 * t + 0.4)); }
  static Vector acceleration(double t) { return pair_of(4 * std::cos(2 * t), -4.5 * std::cos(3 * t + 0.4)); }

  /// Root mean square over the steps to 2 s.  @param long_step  length of every second step over the others'
  double error(const cases::TimeScheme& scheme, int n_steps, double long_step) {
    TimeIntegrator motion(body, scheme, at(displacement(0), velocity(0)), exact_steps());
    const double pair = 4. / n_steps;
    double squares = 0;
    for (int n = 0; n < n_steps; ++n) {
      const double within = n % 2 == 0 ? 1 / (1 + long_step) : 1;
      motion.advance((n / 2 + within) * pair);
      squares += (motion.now().displacement - displacement(motion.now().time)).squaredNorm();
    }
    return std::sqrt(squares / n_steps);
  }
  double order(const cases::TimeScheme& scheme, double long_step = 1) {
    return std::log2(error(scheme, 400, long_step) / error(scheme, 800, long_step));
  }
};

} // namespace

TEST_CASE("a manufactured motion is approached at the order of each scheme", "[verification]") {
  Manufactured motion;
  constexpr double rounding = 0.05; // orders are off by higher powers of a step of 1 % of a radian
  CHECK(motion.order(implicit_euler) == Approx(1).margin(rounding));
  CHECK(motion.order(newmark) == Approx(2).margin(rounding));
  CHECK(motion.order(bdf2) == Approx(2).margin(rounding));
  for (const double rho : {0., 0.5, 1.}) {
    INFO(rho);
    CHECK(motion.order(generalized_alpha(rho)) == Approx(2).margin(rounding));
  }
}

TEST_CASE("bdf2 keeps its order with steps of unequal length", "[verification]") {
  CHECK(Manufactured().order(bdf2, 2) == Approx(2).margin(0.05));
}

TEST_CASE(
    "a support that moves takes a body along, by its springs and by its mass, at the order of the scheme",
    "[verification]") {
  Manufactured motion;
  motion.body.support = [](double t) { return Manufactured::displacement(t)[0]; };
  for (const auto& scheme : {newmark, bdf2, generalized_alpha(0.5)}) {
    INFO(name_of(scheme.scheme));
    CHECK(motion.order(scheme) == Approx(2).margin(0.05));
  }
}

TEST_CASE("the motion starts with the acceleration that the forces give") {
  Manufactured motion;
  const TimeIntegrator start(motion.body, newmark,
                             at(Manufactured::displacement(0), Manufactured::velocity(0)));
  CHECK((start.now().acceleration - Manufactured::acceleration(0)).norm() < 1e-10);
}

TEST_CASE("the implicit Euler method damps an oscillator by the ratio that is printed with its results",
          "[verification]") {
  constexpr double omega = 10;
  for (const double omega_h : {0.02, 0.1, 0.5}) {
    Body body = simple(omega);
    TimeIntegrator motion(body, implicit_euler, released(1), exact_steps());
    const auto size = [&] {
      return std::hypot(motion.now().displacement[0], motion.now().velocity[0] / omega);
    };
    const auto angle = [&] {
      return std::atan2(-motion.now().velocity[0] / omega, motion.now().displacement[0]);
    };
    constexpr int n_steps = 5; // less than half a turn
    for (int n = 1; n <= n_steps; ++n) motion.advance(n * omega_h / omega);
    const double decay = -std::log(size()) / angle();
    const double ratio = decay / std::hypot(1, decay);
    CHECK(ratio == Approx(mechanics::swings_in_steps(implicit_euler, omega_h).damping_ratio).epsilon(1e-9));
    CHECK(ratio == Approx(omega_h / 2).epsilon(omega_h * omega_h));
  }
}

TEST_CASE("newmark keeps the energy of a linear body without damping over 10,000 steps, what damps does not",
          "[verification]") {
  const Matrix mass = rows(2, 0.5, 0.5, 1);
  const Matrix stiffness = rows(50, -20, -20, 900); // 5 and 32 1/s
  const auto largest_change = [&](const cases::TimeScheme& scheme) {
    Body body = linear(mass, stiffness);
    TimeIntegrator motion(body, scheme, at(pair_of(1, 0.3), pair_of(0, 4)));
    const auto energy = [&] {
      const Vector& u = motion.now().displacement;
      return motion.kinetic_energy() + u.dot(stiffness * u) / 2;
    };
    const double start = energy();
    double largest = 0;
    for (int n = 1; n <= 10000; ++n) {
      motion.advance(n * 0.01);
      largest = std::max(largest, std::abs(energy() / start - 1));
    }
    return largest;
  };
  CHECK(largest_change(newmark) <= 1e-9);
  CHECK(largest_change(generalized_alpha(0.5)) > 1e-2);
  CHECK(largest_change(implicit_euler) > 0.9);
}

TEST_CASE("a damped oscillator moves as the formula says", "[verification]") {
  constexpr double omega = 20, zeta = 0.05;
  Body body = simple(omega);
  body.damping(0, 0) = 2 * zeta * omega;
  TimeIntegrator motion(body, newmark, released(1));
  const double damped = omega * std::sqrt(1 - zeta * zeta);
  for (int n = 1; n <= 2000; ++n) {
    motion.advance(n * 5e-4);
    const double t = motion.now().time;
    const double exact =
        std::exp(-zeta * omega * t) * (std::cos(damped * t) + zeta * omega / damped * std::sin(damped * t));
    REQUIRE(std::abs(motion.now().displacement[0] - exact) < 2e-4); // (omega h)²/12 of the phase, 20 radians
  }
}

TEST_CASE("strong damping ends in static equilibrium, by steps far beyond the period") {
  Body body = simple(1);
  body.force = [](const Vector& u) { return Vector(u.array().sinh()); };
  body.stiffness = [](const Vector& u) { return Matrix(Vector(u.array().cosh()).asDiagonal()); };
  body.damping(0, 0) = 20;
  body.load = [](double) { return Vector(Vector::Constant(1, 50)); };
  for (const auto& scheme : {implicit_euler, bdf2, generalized_alpha(0.5)}) {
    TimeIntegrator motion(body, scheme, released(0));
    for (int n = 1; n <= 100; ++n) motion.advance(n * 10);
    INFO(name_of(scheme.scheme));
    CHECK(motion.now().displacement[0] == Approx(std::asinh(50)).epsilon(1e-6));
  }
}

namespace {

/// Two masses of 1 and 3 t, joined by a spring of length 1 mm, and held by nothing.
Body dumbbell() {
  Vector masses(6);
  masses << 1, 1, 1, 3, 3, 3;
  Body result = body(masses.asDiagonal());
  const Eigen::Vector3d apart(1, 0, 0);
  constexpr double k = 400;
  result.force = [=](const Vector& u) {
    const Eigen::Vector3d d = apart + u.tail<3>() - u.head<3>();
    const Eigen::Vector3d pull = k * (d.norm() - 1) * d.normalized();
    Vector force(6);
    force << -pull, pull;
    return force;
  };
  result.stiffness = [=](const Vector& u) {
    const Eigen::Vector3d d = apart + u.tail<3>() - u.head<3>(), n = d.normalized();
    const Eigen::Matrix3d along = n * n.transpose(),
                          block = k * (along + (1 - 1 / d.norm()) * (Eigen::Matrix3d::Identity() - along));
    Matrix all(6, 6);
    all << block, -block, -block, block;
    return all;
  };
  return result;
}

Eigen::Vector3d angular_momentum(const mechanics::Motion& motion) {
  const Eigen::Vector3d first = motion.displacement.head<3>(),
                        second = Eigen::Vector3d(1, 0, 0) + motion.displacement.tail<3>();
  return first.cross(motion.velocity.head<3>()) + 3 * second.cross(motion.velocity.tail<3>());
}

Eigen::Vector3d momentum(const mechanics::Motion& motion) {
  return motion.velocity.head<3>() + 3 * motion.velocity.tail<3>();
}

} // namespace

TEST_CASE(
    "an unheld body that spins keeps its momentum by every scheme, its angular momentum by the midpoint rule",
    "[verification]") {
  Vector velocity(6);
  velocity << 1, -6, 0.5, 1, 4, -0.5;
  const auto changes = [&](const cases::TimeScheme& scheme) {
    Body body = dumbbell();
    TimeIntegrator motion(body, scheme, at(Vector::Zero(6), velocity), exact_steps());
    const Eigen::Vector3d turning = angular_momentum(motion.now()), going = momentum(motion.now());
    for (int n = 1; n <= 1000; ++n) motion.advance(n * 0.005);
    return std::array{(angular_momentum(motion.now()) - turning).norm() / turning.norm(),
                      (momentum(motion.now()) - going).norm() / going.norm()};
  };
  for (const auto& scheme : {implicit_euler, newmark, bdf2, generalized_alpha(0.5), generalized_alpha(1)})
    CHECK(changes(scheme)[1] <= 1e-9);
  CHECK(changes(generalized_alpha(1))[0] <= 1e-9);
  CHECK(changes(implicit_euler)[0] > 1e-3); // the measure sees a change
}

TEST_CASE("a body in free flight falls as the parabola says", "[verification]") {
  Body body = linear(Matrix::Identity(1, 1) * 2, Matrix::Zero(1, 1));
  body.load = [](double) { return Vector(Vector::Constant(1, -2 * 9810)); };
  TimeIntegrator motion(body, newmark, at(Vector::Zero(1), Vector::Constant(1, 3000)));
  for (int n = 1; n <= 1000; ++n) motion.advance(n * 1e-3);
  CHECK(motion.now().displacement[0] == Approx(3000 - 9810 / 2.).epsilon(1e-9));
  CHECK(motion.now().velocity[0] == Approx(3000 - 9810).epsilon(1e-9));
}

TEST_CASE("a step whose equation is not solved is halved until it is") {
  Body body = simple(2 * pi);
  body.least_mass_factor = 4 / (0.06 * 0.06); // newmark's: no step above 0.06 s
  TimeIntegrator motion(body, newmark, released(1), exact_steps());
  for (int n = 1; n <= 10; ++n) motion.advance(n * 0.1);
  CHECK(motion.n_halvings() == 10);
  CHECK(motion.now().time == 1);
  Body other = simple(2 * pi);
  TimeIntegrator of_half_steps(other, newmark, released(1), exact_steps());
  for (int n = 1; n <= 20; ++n) of_half_steps.advance(n * 0.05);
  CHECK(motion.now().displacement[0] == Approx(of_half_steps.now().displacement[0]).epsilon(1e-9));
}

TEST_CASE("what rounding leaves of substeps is no step of its own") {
  Body body = linear(Matrix::Identity(1, 1), Matrix::Zero(1, 1));
  double before = 0, shortest = 1;
  body.load = [&](double t) {
    if (t > before) shortest = std::min(shortest, t - before);
    before = t;
    return Vector(Vector::Zero(1));
  };
  mechanics::IntegrationSettings settings;
  settings.substeps = 300;
  TimeIntegrator motion(body, newmark, at(Vector::Zero(1), Vector::Zero(1)), settings);
  for (int n = 1; n <= 600; ++n) motion.advance(n / 60.);
  CHECK(shortest > 0.99 / 60 / 300);
}

TEST_CASE("a step that no halving helps ends the motion with its time, and what was reached stays") {
  Body body = simple(1);
  TimeIntegrator motion(body, newmark, released(1));
  motion.advance(0.25);
  const double reached = motion.now().displacement[0];
  body.least_mass_factor = std::numeric_limits<double>::infinity();
  CHECK_THROWS_WITH(motion.advance(0.5), "motion, after 0.25 s: no step gets nearer");
  CHECK(motion.now().time == 0.25);
  CHECK(motion.now().displacement[0] == reached);
}

TEST_CASE("where the velocity would lead out of what the law knows, a step begins from where it is") {
  constexpr double omega = 100, step = 0.05, speed = 30;
  Body body = simple(omega);
  body.force = [](const Vector& u) {
    return Vector(Vector::Constant(1, std::abs(u[0]) < 1.2 ? omega * omega * u[0] : std::nan("")));
  };
  TimeIntegrator motion(body, implicit_euler, at(Vector::Zero(1), Vector::Constant(1, speed)));
  motion.advance(step); // the velocity leads to 1.5
  CHECK(motion.n_halvings() == 0);
  CHECK(motion.now().displacement[0] == Approx(step * speed / (1 + std::pow(omega * step, 2))));
}

TEST_CASE("a start without forces is refused, and a request to stop ends a motion") {
  Body body = simple(1);
  mechanics::IntegrationSettings settings;
  settings.newton.should_stop = [] { return true; };
  TimeIntegrator motion(body, newmark, released(1), settings);
  CHECK_THROWS_WITH(motion.advance(1), "motion, after 0 s: it was stopped");
  body.force = [](const Vector&) { return Vector(Vector::Constant(1, std::nan(""))); };
  CHECK_THROWS_AS(TimeIntegrator(body, newmark, released(1)), cases::SolveError);
}
