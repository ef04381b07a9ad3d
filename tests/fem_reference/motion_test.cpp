
#include "cases/case/elements.hpp"
#include "cases/case/error.hpp"
#include "fem_reference/assembled_body.hpp"
#include "fem_reference/inertia.hpp"
#include "fem_reference/model.hpp"
#include "tests/fem_reference/scenes.hpp"
#include "tests/mechanics/dynamics/manufactured_motion.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

using Eigen::Vector3d;
using fem_reference::State;

namespace {

constexpr double youngs_modulus = 0.1, length = 20, side = 10; // MPa, mm
constexpr double density = 1e-9, gravity = 9810;               // t/mm³ of water, mm/s²

/// A bar of 4 x 2 x 2 cells along z, of water, held at its bottom or nowhere, whose tip is watched.
cases::Case bar(bool is_held, cases::Formulation formulation, cases::Element element,
                const cases::MaterialDynamics& dynamics = {1000., 0, 0}, double poissons_ratio = 0.3) {
  cases::Case definition;
  definition.body = cases::Box{{side, side, length}, {2, 2, 4}};
  definition.material = cases::LinearElastic{youngs_modulus, poissons_ratio};
  definition.material_dynamics = dynamics;
  definition.fem.formulation = formulation;
  definition.fem.element = element;
  if (is_held) definition.fixed.push_back({cases::Region{"z-"}, {true, true, true}});
  definition.measures = {{"", cases::measures::Displacement{cases::Region{"x+ y+ z+"}}}};
  return definition;
}

/// Scenes of dynamic cases and of gravity.
cases::Scene weighed(const cases::Case& definition, const Vector3d& along,
                     const std::optional<cases::Dynamics>& dynamics, const cases::History& history = {}) {
  cases::Scene scene = tetrahedra::make_scene(definition);
  cases::Load load{{}, cases::loads::Gravity{9.81 * along}};
  load.history = history;
  scene.definition.loads.push_back(load);
  scene.loads.push_back({{}, load});
  scene.definition.dynamics = dynamics;
  return scene;
}

cases::Dynamics steps(cases::Scheme scheme, double step, double end,
                      cases::MotionStart start = cases::MotionStart::rest) {
  cases::Dynamics dynamics;
  dynamics.scheme.scheme = scheme;
  dynamics.scheme.rho_infinity = 0.5;
  dynamics.step = step;
  dynamics.end = end;
  dynamics.start = start;
  dynamics.write_every = 1000;
  return dynamics;
}

cases::Solution equilibrium(cases::Scene scene) {
  scene.definition.dynamics.reset();
  return fem_reference::Model(scene, MPI_COMM_SELF).solve();
}

} // namespace

TEST_CASE("a bar is stretched by its own weight as analysis says", "[verification]") {
  for (const auto element : {cases::Element::q1, cases::Element::q2, cases::Element::p2}) {
    INFO(name_of(element));
    const cases::Scene scene = weighed(bar(true, cases::Formulation::small_strain, element, {1000., 0, 0}, 0),
                                       Vector3d::UnitZ(), std::nullopt);
    const cases::Solution solution = equilibrium(scene);
    for (std::size_t n = 0; n < solution.displacement.size(); ++n) {
      const double z = scene.mesh.nodes[n].z();
      const double exact = density * gravity / youngs_modulus * (length * z - z * z / 2);
      CHECK(solution.displacement[n].z() == Approx(exact).epsilon(1e-9).margin(1e-15));
    }
  }
}

TEST_CASE("gravity's forces on the nodes add up to all weights") {
  for (const auto element :
       {cases::Element::q1, cases::Element::q2, cases::Element::p1, cases::Element::p2}) {
    cases::Case definition = bar(true, cases::Formulation::small_strain, element);
    definition.masses.push_back({cases::Region{"z+"}, 0.004}); // kg
    const fem_reference::AssembledBody body(weighed(definition, Vector3d::UnitZ(), std::nullopt),
                                            MPI_COMM_SELF);
    double sum = 0;
    for (std::size_t i = 2; i < body.discretisation.load.size(); i += 3) sum += body.discretisation.load[i];
    CHECK(sum == Approx((density * side * side * length + 4e-6) * gravity).epsilon(1e-12)); // N
  }
}

TEST_CASE("finite elements that nothing holds fall as the parabola says, and keep their shape",
          "[verification][long]") {
  for (const auto element :
       {cases::Element::q1, cases::Element::q1_bbar, cases::Element::q2, cases::Element::p1,
        cases::Element::p2, cases::Element::p2_p0, cases::Element::p2_p1})
    for (const auto mass : {cases::ElementMass::consistent, cases::ElementMass::lumped}) {
      INFO(name_of(element) << ", " << name_of(mass));
      cases::Case definition = bar(false, cases::Formulation::log_strain, element);
      definition.fem.mass = mass;
      const cases::Solution motion = fem_reference::follow(
          weighed(definition, -Vector3d::UnitZ(), steps(cases::Scheme::newmark, 0.001, 0.05)));
      for (const Vector3d& moved : motion.displacement)
        CHECK((moved - Vector3d(0, 0, -gravity * 0.05 * 0.05 / 2)).norm() < 1e-6); // the bar falls by 12 mm
    }
}

namespace {

/// Dampers of cells do not go with a pressure of the whole body.
cases::MaterialDynamics damped(cases::Element element) {
  return {1000., 200, cases::facts_of(element).is_mixed ? 0 : 0.01};
}

} // namespace

TEST_CASE("damped finite elements come to rest in their static equilibrium", "[verification][long]") {
  for (const auto formulation : {cases::Formulation::small_strain, cases::Formulation::log_strain})
    for (const auto element :
         {cases::Element::q1, cases::Element::q1_bbar, cases::Element::p2_p0, cases::Element::p2_p1}) {
      INFO(name_of(formulation) << ", " << name_of(element));
      const cases::Scene scene = weighed(bar(true, formulation, element, damped(element)), Vector3d(1, 0, -1),
                                         steps(cases::Scheme::implicit_euler, 0.05, 10));
      const cases::Solution motion = fem_reference::follow(scene), still = equilibrium(scene);
      const double size = largest_displacement(still);
      CHECK(size > 0.1);
      CHECK(largest_difference(motion, still) <= 1e-6 * size);
    }
}

TEST_CASE("finite elements that start in equilibrium stay where they are", "[verification]") {
  for (const auto element :
       {cases::Element::q1, cases::Element::q1_bbar, cases::Element::p2_p0, cases::Element::p2_p1}) {
    const cases::Scene scene =
        weighed(bar(true, cases::Formulation::log_strain, element), Vector3d::UnitX(),
                steps(cases::Scheme::newmark, 0.001, 0.02, cases::MotionStart::equilibrium));
    const cases::Solution motion = fem_reference::follow(scene), still = equilibrium(scene);
    CHECK(largest_difference(motion, still) <= 1e-6 * largest_displacement(still));
  }
}

TEST_CASE("finite elements follow a step far beyond their period to where statics are", "[verification]") {
  for (const auto element :
       {cases::Element::q1, cases::Element::q1_bbar, cases::Element::p2_p0, cases::Element::p2_p1}) {
    INFO(name_of(element));
    const cases::Scene scene = weighed(bar(true, cases::Formulation::log_strain, element), Vector3d::UnitX(),
                                       steps(cases::Scheme::implicit_euler, 1000, 3000));
    const cases::Solution motion = fem_reference::follow(scene), still = equilibrium(scene);
    CHECK(largest_difference(motion, still) <= 1e-6 * largest_displacement(still));
  }
}

TEST_CASE("a support that moves takes damped finite elements along", "[verification]") {
  for (const auto formulation : {cases::Formulation::small_strain, cases::Formulation::log_strain})
    for (const auto element :
         {cases::Element::q1, cases::Element::q1_bbar, cases::Element::p2_p0, cases::Element::p2_p1}) {
      INFO(name_of(formulation) << ", " << name_of(element));
      cases::Case definition = bar(false, formulation, element, damped(element));
      cases::Moved moved;
      moved.region = cases::Region{"z-"};
      moved.displacement = {1, 0, 0.5};
      moved.history.points = {{0., 0.}, {0.1, 1.}};
      definition.moved.push_back(moved);
      const cases::Solution motion = fem_reference::follow(
          weighed(definition, Vector3d::Zero(), steps(cases::Scheme::implicit_euler, 0.05, 10)));
      for (const Vector3d& u : motion.displacement) CHECK((u - moved.displacement).norm() <= 1e-6);
      // Half of it has come after half of the ramp, and the tip has stayed behind.
      const Vector3d tip = motion.trajectory->displacement[1];
      CHECK(tip.x() > 0);
      CHECK(tip.x() < 0.5);
    }
}

TEST_CASE("the tangent of the finite elements' step is the derivative of its residual, inertia included") {
  for (const auto element :
       {cases::Element::q1, cases::Element::q2, cases::Element::p1, cases::Element::p2}) {
    INFO(name_of(element));
    const cases::Scene scene = weighed(bar(true, cases::Formulation::log_strain, element, {1000., 3, 0.02}),
                                       Vector3d::UnitX(), std::nullopt);
    fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
    body.equations.set_in_motion(scene, body.formulations);
    mechanics::DynamicProblem& motion = body.equations;
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> value(-1, 1);
    const auto on_free = [&](double size) {
      State state = body.equations.rest();
      for (Eigen::Index i = 0; i < state.size(); ++i)
        if (!body.discretisation.constraints.is_constrained[cases::index(i)])
          state[i] = size * value(generator);
      return state;
    };
    const State at = on_free(0.2), origin = on_free(0.2), along = on_free(1), force = on_free(0.1),
                supports = body.equations.rest();
    motion.set_step({1e6, 1e3, origin, force, supports, 1});
    constexpr double small = 1e-5; // mm
    const auto residual = [&](double way) -> State {
      return motion.residual(at + way * along, 0, mechanics::Expect::residual);
    };
    const State product = (residual(-small) - residual(small)) / (2 * small);
    // The direction is that of the right side that was assembled at `at`; a difference of two is the
    // tangent's.
    State other_force = force + product;
    motion.residual(at, 0, mechanics::Expect::direction);
    const auto first = motion.direction(at, product, 0, 0, mechanics::Convexity::exact);
    motion.set_step({1e6, 1e3, origin, other_force, supports, 1});
    motion.residual(at, 0, mechanics::Expect::direction);
    const auto second = motion.direction(at, product, 0, 0, mechanics::Convexity::exact);
    REQUIRE((first && second));
    CHECK((*second - *first - along).norm() <= 1e-5 * along.norm());
  }
}

TEST_CASE("finite elements' error in time falls at the order of each scheme", "[verification][long]") {
  const cases::Scene scene =
      weighed(bar(true, cases::Formulation::log_strain, cases::Element::q1, {1000., 3, 0.001}),
              Vector3d::Zero(), std::nullopt);
  fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
  body.equations.set_in_motion(scene, body.formulations);
  mechanics::DynamicProblem& motion = body.equations;
  const auto& points = body.discretisation.nodes.point;
  State shape = body.equations.rest();
  for (std::size_t n = 0; n < points.size(); ++n) { // bends and stretches finitely
    const double along = points[n].z() / length;
    shape.segment<3>(static_cast<Eigen::Index>(3 * n)) = along * along * Vector3d{0.4, -0.2, 0.3};
  }
  check_orders(motion, shape, 400);
}

TEST_CASE("what turns about itself keeps its angular momentum, by the scheme that promises it",
          "[verification]") {
  const cases::Scene scene =
      weighed(bar(false, cases::Formulation::saint_venant_kirchhoff, cases::Element::q1), Vector3d::Zero(),
              std::nullopt);
  fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
  body.equations.set_in_motion(scene, body.formulations);
  mechanics::DynamicProblem& motion = body.equations;
  const auto& points = body.discretisation.nodes.point;
  State velocity = body.equations.rest();
  for (std::size_t n = 0; n < points.size(); ++n) // half a turn in 50 ms about a skew axis, and a pull
    velocity.segment<3>(static_cast<Eigen::Index>(3 * n)) =
        Vector3d(40, 30, 20).cross(points[n]) + Vector3d(0, 0, 2 * points[n].z());
  const auto momentum = [&](const State& displacement, const State& v) {
    State product;
    motion.mass_product(v, product);
    Vector3d linear = Vector3d::Zero(), angular = Vector3d::Zero();
    for (std::size_t n = 0; n < points.size(); ++n) {
      const auto at = static_cast<Eigen::Index>(3 * n);
      const Vector3d place = points[n] + displacement.segment<3>(at), of_node = product.segment<3>(at);
      linear += of_node;
      angular += place.cross(of_node);
    }
    return std::pair{linear, angular};
  };
  const auto [linear, angular] = momentum(body.equations.rest(), velocity);
  mechanics::IntegrationSettings settings = fem_reference::default_steps();
  settings.newton.tolerance = 1e-13;
  mechanics::TimeIntegrator integrator(motion, {cases::Scheme::generalized_alpha, 0.25, 0.5, 1},
                                       {0, body.equations.rest(), velocity, {}}, settings);
  for (int n = 1; n <= 100; ++n) integrator.advance(n * 0.0005);
  const auto [linear_after, angular_after] =
      momentum(integrator.now().displacement, integrator.now().velocity);
  CHECK((linear_after - linear).norm() <= 1e-9 * linear.norm());
  CHECK((angular_after - angular).norm() <= 1e-9 * angular.norm());
}

TEST_CASE("linear finite elements keep their energy over 10,000 steps of newmark", "[verification][long]") {
  const auto element = GENERATE(cases::Element::q1, cases::Element::p1, cases::Element::p2);
  CAPTURE(name_of(element));
  cases::Case definition = bar(true, cases::Formulation::small_strain, element);
  definition.body = cases::Box{{side, side, length}, {1, 1, 2}};
  const cases::Scene scene = tetrahedra::make_scene(definition);
  fem_reference::AssembledBody body(scene, MPI_COMM_SELF);
  body.equations.set_in_motion(scene, body.formulations);
  mechanics::DynamicProblem& motion = body.equations;
  const auto stiffness = fem_reference::rest_stiffness(body.discretisation, body.formulations);
  State start = body.equations.rest();
  const auto& points = body.discretisation.nodes.point;
  for (std::size_t n = 0; n < points.size(); ++n) // bent and stretched, 0 where it is held
    start.segment<3>(static_cast<Eigen::Index>(3 * n)) =
        Vector3d(0.1 * points[n].z() * points[n].z() / length, 0, 0.05 * points[n].z());
  mechanics::TimeIntegrator integrator(motion, {cases::Scheme::newmark},
                                       {0, start, body.equations.rest(), {}}, fem_reference::default_steps());
  const auto energy = [&] {
    const State& u = integrator.now().displacement;
    return integrator.kinetic_energy() + u.dot(stiffness * u) / 2;
  };
  const double at_start = energy();
  double largest = 0;
  for (int n = 1; n <= 10000; ++n) {
    integrator.advance(n * 0.001);
    if (n % 100 == 0) largest = larger(largest, std::abs(energy() / at_start - 1));
  }
  CHECK(largest <= 1e-9);
}
