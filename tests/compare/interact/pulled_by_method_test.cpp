#include "compare/client/methods.hpp"
#include "tests/compare/interact/block.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using compare::PulledBody;
using Method = cases::StepMethod;

/// A block whose springs a method steps.
static cases::Scene stepped(Method method, int iterations, std::optional<int> substeps,
                            const std::string& damping = "mass_damping = 30") {
  cases::Scene scene = block("[3, 3, 4]", damping);
  cases::RealTime& real_time = scene.definition.msm.real_time.emplace();
  real_time.method = method;
  real_time.iterations = iterations;
  real_time.substeps = substeps;
  return scene;
}

/// Places (mm) of a block at the end of each step, pulled from the second to the tenth.
static std::vector<msm::Points> pulled_by_method(const cases::Scene& scene, double stiffness) {
  PulledBody body(scene, {50, stiffness, 1});
  std::vector<msm::Points> all;
  for (int step = 0; step < 15; ++step) {
    if (step == 1) {
      REQUIRE(body.grab(from_right));
      body.drag({10, 0, 3});
    }
    if (step == 10) body.release();
    body.step();
    REQUIRE(body.troubles().n_failures == 0);
    CHECK((body.force().norm() > 0) == (step >= 1 && step < 10));
    CHECK(body.residual() < 1e-6);
    all.push_back(body.displacement());
  }
  return all;
}

TEST_CASE("a body that a method steps is pulled as one whose steps are solved", "[verification]") {
  for (const double stiffness : {1e-3, 1e3}) { // N/mm: the block as a whole has some 0.1
    const std::vector<msm::Points> exact = pulled_by_method(block("[3, 3, 4]"), stiffness),
                                   found =
                                       pulled_by_method(stepped(Method::implicit_euler, 1000, 1), stiffness);
    double difference = 0, size = 0;
    for (std::size_t step = 0; step < found.size(); ++step)
      for (std::size_t n = 0; n < found[step].size(); ++n) {
        difference += (found[step][n] - exact[step][n]).squaredNorm();
        size += exact[step][n].squaredNorm();
      }
    CAPTURE(stiffness, std::sqrt(difference / size));
    CHECK(size > 1);
    CHECK(std::sqrt(difference / size) < 1e-4); // both are solved to a residual of 1e-6
  }
}

TEST_CASE("a body that a method steps begins anew where it began, and moves as before") {
  const cases::Scene scene = stepped(Method::vertex_block_descent, 5, 2);
  PulledBody body(scene, {50, 1e-2, 1});
  const auto pull = [&] {
    REQUIRE(body.grab(from_right));
    body.drag({10, 0, 3});
    for (int step = 0; step < 5; ++step) body.step();
    return body.displacement();
  };
  const msm::Points first = pull();
  body.restart();
  CHECK(pull() == first);
  CHECK(body.method_text() == "vertex_block_descent, 5 iterations, 2 substeps");
}

/// Draws an undamped block by 10 mm for 60 steps, by a soft and by a stiff spring.
static void check_not_driven_on(const cases::Scene& scene, cases::Side model) {
  for (const double stiffness : {1e-2, 1e6}) {
    CAPTURE(stiffness);
    PulledBody body(scene, {50, stiffness, 1, model});
    body.step();
    REQUIRE(body.grab(from_right));
    body.drag({10, 0, 0});
    double largest = 0;
    for (int step = 0; step < 60; ++step) {
      body.step();
      largest = std::max(largest, largest_displacement(body));
    }
    CHECK(body.troubles().n_failures == 0);
    CHECK(largest > 1);
    CHECK(largest < 30); // a swing goes twice as far as the pointer, and what few iterations leave is soft
  }
}

TEST_CASE("a stiff spring does not drive on an undamped body that few iterations step") {
  for (const Method method : {Method::xpbd, Method::projective_dynamics, Method::vertex_block_descent,
                              Method::implicit_euler, Method::symplectic_euler}) {
    CAPTURE(cases::name_of(method));
    check_not_driven_on(stepped(method, 10, {}, ""), cases::Side::msm);
  }
}

/// A block whose elements a method steps.
static cases::Scene stepped(cases::ElementMethod method, int iterations, const std::string& damping) {
  cases::Scene scene = block("[3, 3, 4]", damping);
  cases::ElementRealTime steps;
  steps.method = method;
  steps.iterations = iterations;
  compare::set_steps(scene, steps);
  return scene;
}

TEST_CASE("elements are pulled by every method that hexahedra have") {
  // In the end the block is at rest, where both have the same pull and the corotational law is near the
  // other.
  std::vector<double> ends;
  for (const auto method :
       {cases::ElementMethod::corotational, cases::ElementMethod::total_lagrangian_explicit}) {
    CAPTURE(cases::name_of(method));
    const cases::Scene scene = stepped(method, 100, "mass_damping = 30");
    PulledBody body(scene, {50, 1e-2, 1, cases::Side::fem});
    body.step();
    REQUIRE(body.grab(from_right));
    body.drag({2, 0, 0});
    for (int step = 0; step < 200; ++step) body.step();
    CHECK(body.troubles().n_failures == 0);
    CHECK(body.force().norm() > 0);
    ends.push_back(largest_displacement(body));
    body.restart();
    CHECK(largest_displacement(body) == 0);
  }
  CHECK(ends[0] > 0.1);
  CHECK(ends[1] == Approx(ends[0]).epsilon(0.05));
}

TEST_CASE("a stiff spring does not drive on undamped elements that few iterations step") {
  for (const auto method :
       {cases::ElementMethod::corotational, cases::ElementMethod::total_lagrangian_explicit}) {
    CAPTURE(cases::name_of(method));
    check_not_driven_on(stepped(method, 10, ""), cases::Side::fem);
  }
}
