#include "fem_reference/real_time/real_time.hpp"

#include "cases/case/error.hpp"
#include "cases/scene/loads.hpp"
#include "fem_reference/model.hpp"
#include "mechanics/larger.hpp"
#include "tests/support/free_bar.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using cases::Element;
using cases::ElementMethod;
using cases::ElementRealTime;
using Eigen::Vector3d;
using fem_reference::StepBy;
using fem_reference::SteppedElements;
using Field = std::vector<Vector3d>;

namespace {

const std::vector<ElementMethod> methods{ElementMethod::corotational,
                                         ElementMethod::total_lagrangian_explicit, ElementMethod::xpbd};

/// A bar of water of 3 x 2 x 2 cubes, or as many times six tetrahedra, held at one end, under an acceleration
/// that swings it by a tenth of its length.
/// @param acceleration  m/s²
cases::Scene bar(Element element, const Vector3d& acceleration = {0, 0, -9.81}) {
  cases::Case definition;
  definition.body = cases::Box{{30, 20, 20}, {3, 2, 2}};
  definition.material = cases::LinearElastic{0.003, 0.3};
  definition.fixed.push_back({cases::Region{"x-"}, {true, true, true}});
  definition.material_dynamics = {1000., 1, 0};
  definition.fem.element = element;
  definition.fem.mass = cases::ElementMass::lumped;
  cases::Scene scene = tetrahedra::make_scene(definition);
  scene.loads.push_back({{}, {{}, cases::loads::Gravity{acceleration}}});
  scene.definition.dynamics.emplace();
  scene.definition.dynamics->scheme.scheme = cases::Scheme::implicit_euler;
  scene.definition.dynamics->step = 0.01;
  scene.definition.dynamics->end = 0.03;
  return scene;
}

cases::Scene bar_for(ElementMethod method, const Vector3d& acceleration = {0, 0, -9.81}) {
  return bar(method == ElementMethod::xpbd ? Element::p1 : Element::q1, acceleration);
}

/// The same with cells that are no boxes.
cases::Scene with_skewed_cells(cases::Scene scene) {
  scene.mesh.nodes = scene.mesh.nodes.to_vector();
  scene.mesh.cells = scene.mesh.cells.to_vector();
  scene.mesh.grid.reset();
  for (Vector3d& node : scene.mesh.nodes.stored())
    node += Vector3d(0.02 * node.y() * node.z(), -0.003 * node.x() * node.x(), 0.2 * node.y());
  return scene;
}

ElementRealTime steps(ElementMethod method, int iterations, std::optional<int> substeps = {}) {
  return {method, iterations, substeps, {}, 0.01, 20, 5};
}

Field end_of(const cases::Scene& scene, const ElementRealTime& by, int n_threads = 1) {
  return SteppedElements(scene, by, n_threads).follow({}).displacement;
}

/// Every step of the method's law solved by Newton's method.
Field solved(const cases::Scene& scene, ElementMethod method) {
  return SteppedElements(scene, steps(method, 1), 1).follow({}, StepBy::newton).displacement;
}

/// Largest difference relative to the largest displacement.
double apart(const Field& a, const Field& b) {
  double difference = 0, size = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    difference = mechanics::larger(difference, (a[n] - b[n]).norm());
    size = mechanics::larger(size, b[n].norm());
  }
  return difference / size;
}

const Vector3d force_on_free_bar(1e-4, 2e-4, -1e-4);

/// A bar without supports in ten steps of a millisecond, drawn at a corner.
cases::Scene bar_in_flight(Element element) {
  return free_bar::drawn(bar(element), force_on_free_bar);
}

/// Masses of a bar's nodes, lumped, t.
std::vector<double> masses_of(const cases::Scene& scene) {
  return cases::point_masses(scene, cases::PointMass::cells); // row sums of boxes and tetrahedra
}

} // namespace

TEST_CASE("corotational elements come to their own implicit Euler's motion as iterations grow",
          "[verification]") {
  for (const cases::Scene& scene :
       {bar(Element::q1), bar(Element::q1_bbar), with_skewed_cells(bar(Element::q1)), bar(Element::p1)}) {
    CAPTURE(cases::name_of(scene.definition.fem.element), scene.mesh.grid.has_value());
    const Field exact = solved(scene, ElementMethod::corotational);
    std::array<double, 3> error{};
    for (int n = 0; n < 3; ++n)
      error[std::size_t(n)] = apart(end_of(scene, steps(ElementMethod::corotational, 5 + 5 * n)), exact);
    CAPTURE(error[0], error[1], error[2]);
    CHECK(error[1] < error[0] / 2);
    CHECK(error[2] < error[1] / 2);
    CHECK(apart(end_of(scene, steps(ElementMethod::corotational, 3000)), exact) < 1e-7);
  }
}

TEST_CASE("corotational elements are those of small strains where they turn little", "[verification]") {
  for (const Element element : {Element::q1, Element::q1_bbar, Element::p1}) {
    CAPTURE(cases::name_of(element));
    const auto difference = [&](double part) {
      cases::Scene scene = bar(element, {0, 0, -9.81 * part});
      const Field corotational = solved(scene, ElementMethod::corotational);
      scene.definition.fem.formulation = cases::Formulation::small_strain;
      return apart(corotational, fem_reference::follow(scene).displacement);
    };
    const double hundredth = difference(0.01);
    CAPTURE(hundredth);
    CHECK(hundredth < 0.005);
    CHECK(difference(0.001) < hundredth / 5); // first order in the motion
  }
}

TEST_CASE("explicit total Lagrangian steps come to the elements' own motion, of first order",
          "[verification]") {
  for (cases::Scene scene : {bar(Element::q1), with_skewed_cells(bar(Element::q1)), bar(Element::p1)}) {
    CAPTURE(cases::name_of(scene.definition.fem.element), scene.mesh.grid.has_value());
    // The finite elements of motions with lumped masses, by Newmark's method with short steps.
    cases::Scene fine = scene;
    fine.definition.dynamics->scheme = {};
    fine.definition.dynamics->step = 1e-4;
    const Field exact = fem_reference::follow(fine).displacement;
    std::array<double, 3> error{};
    for (int n = 0; n < 3; ++n)
      error[std::size_t(n)] =
          apart(end_of(scene, steps(ElementMethod::total_lagrangian_explicit, 1, 25 << n)), exact);
    CAPTURE(error[0], error[1], error[2]);
    CHECK(error[0] / error[1] == Approx(2).margin(0.3));
    CHECK(error[1] / error[2] == Approx(2).margin(0.3));
  }
}

TEST_CASE("XPBD's tetrahedra come to the motion of their law's elements as substeps grow", "[verification]") {
  // The same law at the points of elements, by implicit Euler with as many steps, which Newton's method
  // solves.
  const auto difference = [](int substeps) {
    const cases::Scene scene = bar(Element::p1);
    cases::Scene fine = scene;
    fine.definition.dynamics->step /= substeps;
    return apart(end_of(scene, steps(ElementMethod::xpbd, 30, substeps)), solved(fine, ElementMethod::xpbd));
  };
  const std::array<double, 3> error{difference(4), difference(16), difference(64)};
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[1] < error[0] / 2);
  CHECK(error[2] < error[1] / 2);
}

TEST_CASE("explicit steps are as many as are stable, and diverge with few", "[verification]") {
  cases::Scene scene = bar(Element::q1, {9.81, 0, 0});
  scene.definition.dynamics->end = 1;
  const Field at = end_of(scene, steps(ElementMethod::total_lagrangian_explicit, 1));
  CHECK(apart(at, solved(scene, ElementMethod::total_lagrangian_explicit)) < 1); // implicit Euler damps it
  CHECK_THROWS_AS(end_of(scene, steps(ElementMethod::total_lagrangian_explicit, 1, 1)), cases::SolveError);
}

TEST_CASE("elements that a method steps end the same to the bit on any number of threads", "[verification]") {
  for (const ElementMethod method : methods) {
    CAPTURE(cases::name_of(method));
    const cases::Scene scene = bar_for(method);
    CHECK(end_of(scene, steps(method, 7), 3) == end_of(scene, steps(method, 7)));
  }
}

TEST_CASE("steps of elements keep the momentum of a free body", "[verification]") {
  for (const ElementMethod method : methods) {
    CAPTURE(cases::name_of(method));
    // The linear solver has to end: what it leaves is no pair of forces.
    const cases::Scene scene = bar_in_flight(method == ElementMethod::xpbd ? Element::p1 : Element::q1);
    const Field at = end_of(scene, steps(method, method == ElementMethod::xpbd ? 4 : 1000, 2));
    const std::vector<double> masses = masses_of(scene);
    Vector3d moved = Vector3d::Zero();
    for (std::size_t n = 0; n < at.size(); ++n) moved += masses[n] * at[n];
    const double factor = 0.25e-6 * 20 * 21 / 2; // s²: sum of n h² of twenty substeps
    CHECK((moved - factor * force_on_free_bar).norm() < 1e-9 * factor * force_on_free_bar.norm());
  }
}

TEST_CASE("explicit steps keep the angular momentum of a free body", "[verification]") {
  for (const Element element : {Element::q1, Element::p1}) {
    cases::Scene scene = bar_in_flight(element);
    scene.definition.dynamics->step = 2e-4; // stable
    scene.definition.dynamics->end = 2e-3;
    scene.loads.front().load.history.points = {{0, 1}, {8e-4, 1}, {8e-4, 0}};
    const auto bodies = SteppedElements(scene, steps(ElementMethod::total_lagrangian_explicit, 1, 1), 1)
                            .follow({})
                            .trajectory->bodies;
    const std::vector<double> masses = masses_of(scene);
    const auto at_step = [&](std::size_t step) { // with v = (x - x before)/h, times h
      Vector3d sum = Vector3d::Zero();
      for (std::size_t n = 0; n < masses.size(); ++n) {
        const Vector3d now = Vector3d(scene.mesh.nodes[n]) + bodies[step].displacement[n];
        sum += masses[n] * now.cross(bodies[step].displacement[n] - bodies[step - 1].displacement[n]);
      }
      return sum;
    };
    const double change = (at_step(10) - at_step(5)).norm() / at_step(5).norm();
    CAPTURE(1e12 * change);
    CHECK(change < 1e-10); // rounding of places over steps
  }
}

TEST_CASE("explicit steps keep a swing's height, where implicit ones lose it", "[verification]") {
  // Symplectic Euler's energy errs by a bounded amount, of first order in the step.
  cases::Scene scene = bar(Element::q1);
  scene.definition.material_dynamics.mass_damping = 0;
  scene.definition.dynamics->end = 4; // some twenty swings
  const auto lowest = [&](const cases::Solution& solution, double begin, double end) {
    double found = 0;
    for (const auto& body : solution.trajectory->bodies)
      if (const double t = body.step * scene.definition.dynamics->step; t >= begin && t <= end)
        found = std::min(found, body.displacement.back().z());
    return found;
  };
  const cases::Solution kept =
      SteppedElements(scene, steps(ElementMethod::total_lagrangian_explicit, 1), 1).follow({});
  CHECK(lowest(kept, 3, 4) / lowest(kept, 0, 1) == Approx(1).margin(0.05)); // higher modes come and go
  const cases::Solution lost = SteppedElements(scene, steps(ElementMethod::corotational, 50), 1).follow({});
  CHECK(lowest(lost, 3, 4) / lowest(lost, 0, 1) < 0.8);
}

TEST_CASE("a body of elements comes to rest in the equilibrium of its law", "[verification]") {
  const auto apart_at_rest = [](ElementMethod method, int iterations, std::optional<int> substeps) {
    cases::Scene scene = bar_for(method);
    scene.definition.dynamics.reset();
    SteppedElements elements(scene, steps(method, iterations, substeps), 1);
    const cases::Solution rest = elements.come_to_rest();
    REQUIRE(rest.from_equilibrium);
    REQUIRE(rest.from_equilibrium->rest);
    CHECK(rest.from_equilibrium->rest->time < 20);
    return apart(rest.displacement, elements.equilibrium());
  };
  // Up to what a node creeps by unseen.
  CHECK(apart_at_rest(ElementMethod::corotational, 10, {}) < 1e-3);
  CHECK(apart_at_rest(ElementMethod::total_lagrangian_explicit, 1, {}) < 1e-3);
  const double few = apart_at_rest(ElementMethod::xpbd, 1, 20),
               more = apart_at_rest(ElementMethod::xpbd, 1, 80);
  CAPTURE(few, more);
  CHECK(few > 1e-3);
  CHECK(more < few / 2);
}

TEST_CASE("elements come to rest in balance with a spring that holds a place of theirs",
          "[verification][long]") {
  for (const ElementMethod method : methods) {
    CAPTURE(cases::name_of(method));
    cases::Scene scene = bar_for(method, Vector3d::Zero());
    scene.definition.material_dynamics.mass_damping = 10; // 1/s: five seconds leave exp(-25) of a swing
    const int iterations = method == ElementMethod::xpbd ? 1 : 30;
    SteppedElements elements(
        scene, steps(method, iterations, method == ElementMethod::xpbd ? std::optional(50) : std::nullopt),
        1);
    mechanics::PointsInTime& points = elements.points();
    const std::size_t tip = scene.mesh.nodes.size() - 1, beside = tip - 1;
    const double stiffness = 1e-3; // N/mm, some of the bar's own
    const mechanics::PullOfPoints& pull =
        points.hold({{{tip, 0.75}, {beside, 0.25}}, stiffness, Vector3d(0, 0, 4)});
    const mechanics::Vector zero = mechanics::Vector::Zero(static_cast<Eigen::Index>(3 * (tip + 1)));
    mechanics::TimeIntegrator motion(points, scene.definition.dynamics->scheme, {0, zero, zero, {}},
                                     elements.settings());
    for (int n = 1; n <= 500; ++n) motion.advance(0.01 * n);
    const Vector3d place = pull.mean(mechanics::to_points(motion.now().displacement));
    CAPTURE(place.transpose(), motion.work().residual);
    CHECK(place.z() > 0.4);
    CHECK(place.z() < 3.6);
    CHECK(motion.work().residual < 0.02); // relative to the pull, which is all that acts
    points.let_go();
    for (int n = 501; n <= 1000; ++n) motion.advance(0.01 * n);
    // Neither constraint of a neo-Hookean tetrahedron is zero at rest: what one iteration leaves of them
    // deforms it.
    const double left = method == ElementMethod::xpbd ? 0.02 : 1e-6;
    CHECK(mechanics::to_points(motion.now().displacement)[tip].norm() < left * place.z());
  }
}

TEST_CASE("the equilibrium of explicit steps is that of the finite elements", "[verification]") {
  cases::Scene scene = bar(Element::q1);
  scene.definition.dynamics.reset();
  SteppedElements elements(scene, steps(ElementMethod::total_lagrangian_explicit, 1), 1);
  elements.come_to_rest();
  fem_reference::Model model(scene, MPI_COMM_SELF);
  CHECK(apart(elements.equilibrium(), model.solve().displacement) < 1e-7);
}
