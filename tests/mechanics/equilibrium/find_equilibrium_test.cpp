#include "mechanics/equilibrium/find_equilibrium.hpp"

#include "cases/case/error.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

using namespace springproof;

using mechanics::EquilibriumSettings;
using mechanics::Vector;

namespace {

/// One degree of freedom: load factor * load = force(u).
struct Bar : mechanics::NonlinearProblem {
  std::function<double(double)> force, stiffness, stored; ///< N, N/mm, N mm
  double load = 1;
  mechanics::Merit by = mechanics::Merit::energy;

  void residual(const Vector& at, double load_factor, mechanics::Expect, Vector& residual) override {
    ++n_evaluations;
    residual = Vector::Constant(1, load_factor * load - force(at[0]));
  }
  Size size(const Vector& residual, const Vector&) override { return {std::abs(residual[0] / load)}; }
  bool direction(const Vector& at, const Vector& residual, double, double, mechanics::Convexity,
                 Vector& step) override {
    const double tangent = stiffness(at[0]);
    step = residual / tangent;
    return tangent > 0;
  }
  mechanics::Merit merit() const override { return by; }
  double energy(const Vector& at, double load_factor) override {
    return stored(at[0]) - load_factor * load * at[0];
  }
  std::optional<bool> is_stable(const Vector& at) override { return stiffness(at[0]) > 0; }
  Work work() const override { return {0, 0, n_evaluations}; }
  std::size_t n_unknowns() const override { return 1; }
  long n_evaluations = 5; ///< some before any path
};

/// f = sinh(u): stiffens.
Bar stiffening() {
  Bar bar;
  bar.force = [](double u) { return std::sinh(u); };
  bar.stiffness = bar.stored = [](double u) { return std::cosh(u); };
  return bar;
}

/// f = u - u³, which has its maximum 2/sqrt(27) at u = 1/sqrt(3).
Bar snapping() {
  Bar bar;
  bar.force = [](double u) { return u - u * u * u; };
  bar.stiffness = [](double u) { return 1 - 3 * u * u; };
  bar.stored = [](double u) { return u * u / 2 - u * u * u * u / 4; };
  return bar;
}

const Vector rest = Vector::Zero(1);

mechanics::Equilibrium solve(Bar& bar, const EquilibriumSettings& settings = {}) {
  return mechanics::find_equilibrium(bar, rest, "bar", settings);
}

cases::SolveError error_of(Bar& bar, const EquilibriumSettings& settings = {}) {
  try {
    solve(bar, settings);
  } catch (const cases::SolveError& error) {
    return error;
  }
  FAIL("an equilibrium was reported");
  return cases::SolveError("");
}

} // namespace

TEST_CASE("a stiffening bar is in equilibrium under its load by either merit of the line search") {
  for (const auto by : {mechanics::Merit::energy, mechanics::Merit::work, mechanics::Merit::none}) {
    Bar bar = stiffening();
    bar.by = by;
    bar.load = 50;
    CHECK(solve(bar).state[0] ==
          Approx(std::asinh(50)).epsilon(1e-8)); // 1e-9 of the load, over a stiffness of 50
  }
}

TEST_CASE("a path ends at its limit point, when every equilibrium on it has to be stable") {
  Bar bar = snapping();
  const cases::SolveError error = error_of(bar);
  CHECK(error.outcome() == cases::Outcome::limit_point);
  CHECK(error.load_reached() == Approx(2 / std::sqrt(27.0)).margin(2e-4)); // twice the smallest step
}

TEST_CASE("a path that ends early has counted its work, as one that arrives has") {
  Bar bar = snapping();
  const cases::Solution failed = error_of(bar).so_far();
  CHECK(failed.status == cases::Status::failed);
  CHECK(failed.message == "bar: no equilibrium was found beyond this load");
  CHECK(failed.unknowns == 1);
  CHECK(failed.newton_iterations > 0);
  CHECK(failed.force_evaluations > failed.newton_iterations);
  CHECK(failed.force_evaluations == bar.n_evaluations - 5);
  Bar light = snapping();
  light.load = 0.1;
  const mechanics::Equilibrium found = solve(light);
  CHECK(found.n_unknowns == 1);
  CHECK(found.work.force_evaluations == light.n_evaluations - 5);
}

TEST_CASE("a path that ends without its stability known has an unknown outcome, and says what failed") {
  Bar bar = snapping();
  EquilibriumSettings settings;
  settings.stability = mechanics::Stability::ignore;
  const cases::SolveError error = error_of(bar, settings);
  CHECK(error.outcome() == cases::Outcome::unknown);
  CHECK_THAT(error.what(), Catch::Contains("bar: no equilibrium was found beyond this load: "));
}

TEST_CASE("a path may start at any load factor at which its start is in equilibrium") {
  Bar bar = stiffening();
  EquilibriumSettings settings;
  settings.from = 2;
  settings.to = 3;
  const Vector start = Vector::Constant(1, std::asinh(2.0));
  const auto found = mechanics::find_equilibrium(bar, start, "bar", settings);
  CHECK(found.state[0] == Approx(std::asinh(3.0)).epsilon(1e-8));
  CHECK(found.load_reached == 3);
}

TEST_CASE("a step of Newmark's method is a path like any other: inertia is in the residual and the tangent") {
  // M a + f(u) = load with a = (u - u0)/(beta h²), from rest: (M/(beta h²) + K) is the tangent.
  const double inertia = 4 / (0.25 * 0.1 * 0.1);
  const Bar spring = stiffening();
  Bar moving = spring;
  moving.force = [&](double u) { return inertia * u + spring.force(u); };
  moving.stiffness = [&](double u) { return inertia + spring.stiffness(u); };
  moving.stored = [&](double u) { return inertia * u * u / 2 + spring.stored(u); };
  const double u = solve(moving).state[0];
  CHECK(inertia * u + std::sinh(u) == Approx(1).epsilon(1e-9));
}

TEST_CASE("limits on load steps and Newton iterations, and a request to stop, end a path with their reason") {
  Bar bar = stiffening();
  const auto message = [&](const std::function<void(EquilibriumSettings&)>& limit) {
    EquilibriumSettings settings;
    settings.first_load_step = settings.largest_load_step = 0.125;
    limit(settings);
    return std::string(error_of(bar, settings).what());
  };
  CHECK(message([](auto& s) { s.max_load_steps = 3; }) == "bar: the limit on load steps was reached");
  CHECK(message([](auto& s) { s.max_newton_iterations = 3; }) ==
        "bar: the limit on Newton iterations was reached");
  CHECK(message([](auto& s) { s.should_stop = [] { return true; }; }) == "bar: it was stopped");
}

TEST_CASE("load steps turn a support by 30 degrees at most, and leave room for halving") {
  const auto steps_of = [](double degrees, double from, double to) {
    mechanics::EquilibriumSettings settings;
    settings.from = from;
    settings.to = to;
    settings.smallest_load_step = 0.1;
    return mechanics::in_small_turns(degrees, 1, settings);
  };
  CHECK(steps_of(0, 0, 1).largest_load_step == 1);
  CHECK(steps_of(30, 0, 1).first_load_step == 1);
  for (const double degrees : {31., 270., -300., 360., 720., 1e6}) {
    const auto settings = steps_of(degrees, 0, 1);
    CHECK(settings.largest_load_step * std::abs(degrees) <= 30);
    CHECK(settings.largest_load_step * std::abs(degrees) > 15);
    CHECK(settings.first_load_step == settings.largest_load_step);
    CHECK(settings.smallest_load_step <= settings.largest_load_step / 10);
  }
  CHECK(steps_of(300, 0.5, 0.6).largest_load_step == 1); // 30 degrees of the way
}

TEST_CASE("as many load steps as are asked for do not meet the limits of a path") {
  Bar bar = stiffening();
  EquilibriumSettings settings;
  settings.max_load_steps = 400;
  settings.max_newton_iterations = 300; // as finite elements have
  const auto found = solve(bar, mechanics::in_small_turns(0, 1000, settings));
  CHECK(found.load_reached == 1);
  CHECK(found.load_steps >= 1000);
}

TEST_CASE("load steps that are smaller already stay as they are") {
  mechanics::EquilibriumSettings settings;
  settings.first_load_step = 0.01;
  settings.largest_load_step = 0.02;
  const auto turned = mechanics::in_small_turns(90, 1, settings);
  CHECK(turned.first_load_step == 0.01);
  CHECK(turned.largest_load_step == 0.02);
}
