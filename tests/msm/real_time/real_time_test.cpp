#include "tests/msm/real_time/bar.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "msm/design/design.hpp"
#include "msm/real_time/colours.hpp"
#include "tests/support/free_bar.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using cases::StepMethod;
using Eigen::Vector3d;

TEST_CASE("a method comes to implicit Euler's motion as iterations grow, each as much nearer",
          "[verification]") {
  struct Rate {
    StepMethod method;
    std::array<int, 3> iterations; // in equal steps
  };
  for (const auto& [method, iterations] : {Rate{StepMethod::projective_dynamics, {20, 60, 100}},
                                           Rate{StepMethod::vertex_block_descent, {20, 60, 100}},
                                           // a linear solution takes some five
                                           Rate{StepMethod::implicit_euler, {5, 15, 25}}}) {
    CAPTURE(cases::name_of(method));
    const msm::Points exact = solved(bar(method, 1, sideways));
    std::array<double, 3> error{};
    for (std::size_t n = 0; n < 3; ++n) error[n] = apart(end_of(bar(method, iterations[n], sideways)), exact);
    CAPTURE(error[0], error[1], error[2]);
    CHECK(error[1] < error[0] / 2);
    CHECK(error[2] < error[1] / 2);
    CHECK(apart(end_of(bar(method, 3000, sideways)), exact) < 1e-7); // Newton's own tolerance leaves 1e-8
  }
}

TEST_CASE("Chebyshev's method takes projective dynamics to implicit Euler's motion at its own rate",
          "[verification]") {
  const msm::Points exact = solved(bar(StepMethod::projective_dynamics, 1, sideways));
  const auto error = [&](int iterations, std::optional<double> chebyshev) {
    cases::Scene scene = bar(StepMethod::projective_dynamics, iterations, sideways);
    scene.definition.msm.real_time->chebyshev = chebyshev;
    return apart(end_of(scene), exact);
  };
  const auto rate = [&](int from, int to, std::optional<double> chebyshev) {
    return std::pow(error(to, chebyshev) / error(from, chebyshev), 1. / (to - from));
  };
  const double radius = rate(200, 300, {}), plain = rate(60, 100, {}), accelerated = rate(60, 100, radius);
  CAPTURE(radius, plain, accelerated);
  // In the limit radius/(1 + sqrt(1 - radius²)); the first iterations are of other modes.
  CHECK(accelerated == Approx(radius / (1 + std::sqrt(1 - radius * radius))).epsilon(0.05));
  CHECK(error(100, radius) < error(100, {}) / 10);
}

TEST_CASE("XPBD comes to implicit Euler's motion but for the turning of its gradients", "[verification]") {
  const auto left = [](double part) {
    const Vector3d load = part * sideways;
    return apart(end_of(bar(StepMethod::xpbd, 3000, load)), solved(bar(StepMethod::xpbd, 1, load)));
  };
  const double whole = left(1), tenth = left(0.1);
  CAPTURE(whole, tenth);
  CHECK(tenth < whole / 5); // first order in the motion
  CHECK(left(1e-5) < 1e-5);
  const msm::Points limit = end_of(bar(StepMethod::xpbd, 3000, sideways));
  std::array<double, 3> error{};
  for (std::size_t n = 0; n < 3; ++n)
    error[n] = apart(end_of(bar(StepMethod::xpbd, 200 + 200 * int(n), sideways)), limit);
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[1] < error[0] / 2);
  CHECK(error[2] < error[1] / 2);
}

/// Steps of Macklin et al. (2019), of one iteration each, on springs alone under gravity: another program for
/// what xpbd does with substeps, with velocities and masses in place of a step's equation.
static msm::Points plain_xpbd(const cases::Scene& scene, const msm::Lattice& lattice, int n_steps, double h,
                              const Vector3d& acceleration) {
  const std::vector<double> masses = cases::point_masses(scene);
  const std::vector<bool> is_held = cases::constrained_dofs(scene);
  const double slowed = 1 + h * scene.definition.material_dynamics.mass_damping;
  const auto weight = [&](int p) {
    return is_held[3 * cases::index(p)] ? 0 : 1 / (masses[cases::index(p)] * slowed);
  };
  msm::Points x = lattice.rest, velocity(x.size(), Vector3d::Zero());
  const mechanics::Colours order = mechanics::colour(msm::nodes_of_terms(lattice), x.size());
  for (int step = 0; step < n_steps; ++step) {
    const msm::Points before = x;
    for (std::size_t p = 0; p < x.size(); ++p)
      if (!is_held[3 * p]) x[p] += h * (velocity[p] + h * 1000 * acceleration) / slowed; // mm
    for (const std::vector<int>& links : order)
      for (const int number : links) {
        const auto& [i, j, spring] = lattice.links[cases::index(number)];
        const double compliance = 1 / (spring.stiffness * h * h), weights = weight(i) + weight(j);
        if (weights == 0) continue;
        const Vector3d d = x[cases::index(j)] - x[cases::index(i)];
        const double multiplier = -(d.norm() - spring.rest_length) / (weights + compliance);
        x[cases::index(i)] -= weight(i) * multiplier * d.normalized();
        x[cases::index(j)] += weight(j) * multiplier * d.normalized();
      }
    for (std::size_t p = 0; p < x.size(); ++p) velocity[p] = (x[p] - before[p]) / h;
  }
  for (std::size_t p = 0; p < x.size(); ++p) x[p] -= lattice.rest[p];
  return x;
}

TEST_CASE("substeps of XPBD are those of a plain program", "[verification]") {
  const msm::SpringBody springs{msm::CellStiffness{0.2, 0.1, 0.3}};
  cases::Scene scene = bar(StepMethod::xpbd, 1, sideways);
  scene.definition.msm.real_time->substeps = 10;
  const msm::Points ours =
      msm::follow(scene, springs, {msm::Path::automatic, 2, {}, {}}, msm::in_substeps(scene, springs, 0.01))
          .displacement;
  const msm::Points plain = plain_xpbd(scene, msm::make_lattice(scene.mesh, springs), 30, 0.001, sideways);
  CHECK(apart(ours, plain) < 1e-10); // sums in another order
}

TEST_CASE("symplectic Euler comes to the motion as its substeps grow, of first order", "[verification]") {
  // A converged motion: Newmark's method with short steps.
  cases::Scene fine = bar(StepMethod::symplectic_euler, 1, sideways);
  fine.definition.msm.real_time.reset();
  fine.definition.dynamics->scheme = {};
  fine.definition.dynamics->step = 1e-5;
  fine.definition.dynamics->end = 0.02;
  const msm::Points exact = end_of(fine);
  std::array<double, 3> error{};
  for (std::size_t n = 0; n < 3; ++n) {
    cases::Scene scene = bar(StepMethod::symplectic_euler, 1, sideways);
    scene.definition.msm.real_time->substeps = 100 << n;
    scene.definition.dynamics->end = 0.02;
    error[n] = apart(end_of(scene), exact);
  }
  CAPTURE(error[0], error[1], error[2]);
  CHECK(error[0] / error[1] == Approx(2).margin(0.3));
  CHECK(error[1] / error[2] == Approx(2).margin(0.3));
}

TEST_CASE("symplectic Euler takes as many substeps as are stable, and diverges with few", "[verification]") {
  cases::Scene scene = bar(StepMethod::symplectic_euler, 1, lengthwise);
  scene.definition.dynamics->end = 1;
  CHECK(apart(end_of(scene), solved(scene)) < 0.5);
  scene.definition.msm.real_time->substeps = 1;
  CHECK_THROWS_AS(end_of(scene), cases::SolveError);
}

TEST_CASE("the answer of a method is the same to the bit on any number of threads", "[verification]") {
  for (const std::string& name : cases::all_names<StepMethod>()) {
    CAPTURE(name);
    const StepMethod method = *cases::value_of<StepMethod>(name);
    const cases::Scene scene = bar(method, 7, sideways);
    CHECK(end_of(scene, 3) == end_of(scene, 1));
  }
}

static const Vector3d force_on_free_bar(0.01, 0.02, -0.01);

/// A bar without supports in ten steps of a millisecond, drawn at a corner.
static cases::Scene bar_in_flight(StepMethod method, int iterations) {
  return free_bar::drawn(bar(method, iterations, Vector3d::Zero()), force_on_free_bar);
}

TEST_CASE("forces of a method's steps keep the momentum of a free body", "[verification]") {
  for (const std::string& name : cases::all_names<StepMethod>()) {
    CAPTURE(name);
    const StepMethod method = *cases::value_of<StepMethod>(name);
    // Implicit Euler's linear solver has to end: what it leaves is no pair of forces.
    cases::Scene scene = bar_in_flight(method, method == StepMethod::implicit_euler ? 1000 : 4);
    scene.definition.msm.real_time->substeps = 2;
    const msm::Points at = end_of(scene);
    const std::vector<double> masses = cases::point_masses(scene);
    Vector3d moved = Vector3d::Zero();
    double mass = 0;
    for (std::size_t p = 0; p < at.size(); ++p) {
      moved += masses[p] * at[p];
      mass += masses[p];
    }
    const double factor = 0.25e-6 * 20 * 21 / 2; // s²: sum of n h² of twenty substeps
    const Vector3d expected = factor * force_on_free_bar;
    // Vertex block descent solves no pair of nodes at once: its forces have no counterforces until it ends.
    if (method == StepMethod::vertex_block_descent)
      CHECK((moved - expected).norm() > 1e-6 * expected.norm());
    else
      CHECK((moved - expected).norm() < 1e-9 * expected.norm());
  }
}

TEST_CASE("symplectic Euler keeps the angular momentum of a free body, implicit Euler damps it",
          "[verification]") {
  // The velocity is (x - x before)/h. A step of implicit Euler takes h sum m (v x v before) away from it.
  const auto change = [](StepMethod method) {
    cases::Scene scene = bar_in_flight(method, 1000);
    scene.definition.dynamics->step = 1e-4; // stable
    scene.definition.dynamics->end = 1e-3;
    scene.loads.front().load.history.points = {{0, 1}, {4e-4, 1}, {4e-4, 0}};
    scene.definition.msm.real_time->substeps = 1;
    const auto bodies =
        msm::follow(scene, {springs_of_cells}, {msm::Path::direct, 1, {}, {}}, {}).trajectory->bodies;
    const std::vector<double> masses = cases::point_masses(scene);
    const auto at_step = [&](std::size_t n) {
      Vector3d sum = Vector3d::Zero();
      for (std::size_t p = 0; p < masses.size(); ++p) {
        const Vector3d now = scene.mesh.nodes[p] + bodies[n].displacement[p];
        sum += masses[p] * now.cross(bodies[n].displacement[p] - bodies[n - 1].displacement[p]);
      }
      return sum;
    };
    return (at_step(10) - at_step(5)).norm() / at_step(5).norm();
  };
  const double kept = change(StepMethod::symplectic_euler), lost = change(StepMethod::implicit_euler);
  CAPTURE(1e12 * kept, 1e12 * lost);
  CHECK(kept < 1e-12); // rounding of places over steps
  CHECK(lost > 1e-6);
}

/// Distance of where a bar comes to rest from its equilibrium.
static double apart_at_rest(StepMethod method, int iterations) {
  cases::Scene scene = bar(method, iterations, sideways);
  scene.definition.dynamics.reset();
  scene.definition.material_dynamics.mass_damping = 0;
  const cases::Solution rest = msm::come_to_rest(scene, {springs_of_cells}, 1);
  REQUIRE(rest.from_equilibrium);
  REQUIRE(rest.from_equilibrium->rest);
  CHECK(rest.from_equilibrium->rest->time < 20);
  CHECK(rest.from_equilibrium->rest->steps == Approx(rest.from_equilibrium->rest->time / 0.01));
  return apart(rest.displacement, msm::Model(scene, {springs_of_cells}).solve().displacement);
}

TEST_CASE("a body comes to rest in the springs' equilibrium", "[verification]") {
  // Up to what a node creeps by unseen. These begin a step at rest where the body is.
  CHECK(apart_at_rest(StepMethod::implicit_euler, 5) < 1e-3);
  CHECK(apart_at_rest(StepMethod::vertex_block_descent, 5) < 1e-3);
  // These begin in free flight, which leaves a body at rest out of balance until the iterations suffice.
  for (const StepMethod method : {StepMethod::projective_dynamics, StepMethod::xpbd}) {
    const double few = apart_at_rest(method, 50), more = apart_at_rest(method, 200);
    CAPTURE(cases::name_of(method), few, more);
    CHECK(few > 0.01);
    CHECK(more < few / 2);
  }
}

/// Where a vertex of the thesis's cube under small shear comes to rest, mm along the load: points of equal
/// masses.
static double sheared_cube_at_rest(StepMethod method, int iterations) {
  cases::Case definition;
  definition.body = cases::Box{{10, 10, 10}, {10, 10, 10}};
  definition.fixed.push_back({cases::Region{"z-"}, {true, true, true}});
  definition.material_dynamics = {1000., 0, 0};
  definition.msm.mass = cases::PointMass::uniform;
  cases::Scene scene = cases::make_scene(definition);
  cases::Scene::AppliedLoad load{{}, {{}, cases::loads::NodalForce{{0.002, 0, 0}}}};
  std::size_t vertex = 0; // x- y- z+
  for (std::size_t p = 0; p < scene.mesh.nodes.size(); ++p) {
    const Vector3d& node = scene.mesh.nodes[p];
    if (node.z() > 9.9) load.selection.nodes.push_back(static_cast<int>(p));
    if (node.isApprox(Vector3d(0, 0, 10))) vertex = p;
  }
  scene.loads.push_back(load);
  scene.definition.msm.real_time = cases::RealTime{method, iterations, {}, {}, 1. / 60, 20, 4};
  msm::DesignRequest request;
  request.material = cases::LinearElastic{0.3, 0.35};
  request.options.design = cases::Design::moduli;
  return msm::come_to_rest(scene, msm::design(request).springs, 2).displacement[vertex].x();
}

TEST_CASE("projective dynamics and implicit Euler rest where another program's do", "[verification]") {
  // Trials of a hundred lines each, written before these methods and without their code; margins are the last
  // digits that they printed.
  CHECK(sheared_cube_at_rest(StepMethod::projective_dynamics, 1) == Approx(4.76).margin(0.005));
  CHECK(sheared_cube_at_rest(StepMethod::projective_dynamics, 10) == Approx(2.58).margin(0.005));
  CHECK(sheared_cube_at_rest(StepMethod::implicit_euler, 10) == Approx(0.628).margin(0.0005));
}

TEST_CASE("a network without cells comes to rest in its equilibrium, by every method", "[verification]") {
  const TemporaryFolder folder;
  folder.write("nodes.csv", "0,0,0,0.1\n10,0,0,0.2\n20,0,0,0.1\n10,10,0,0.2\n10,4,10,0.2\n");
  folder.write("springs.csv",
               "0,1,900\n1,2,900\n0,3,900\n1,3,900\n2,3,900\n0,4,900\n1,4,900\n2,4,900\n3,4,900\n");
  const std::string text = R"(schema = 1
name = "network"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[[fixed]]
region = "near 0 0 0"
[[fixed]]
region = "near 20 0 0"
[[fixed]]
region = "near 10 10 0"
[[load]]
kind = "gravity"
value = [0, 1, -2]
[msm]
real_time = { method = "xpbd", iterations = 50 }
)";
  cases::Scene scene = cases::make_scene(cases::read_case(folder.write("case.toml", text)));
  const msm::SpringBody springs{scene.network};
  const msm::Points equilibrium = msm::Model(scene, springs).solve().displacement;
  for (const std::string& name : cases::all_names<StepMethod>()) {
    CAPTURE(name);
    cases::RealTime& steps = *scene.definition.msm.real_time;
    steps.method = *cases::value_of<StepMethod>(name);
    if (steps.method == StepMethod::xpbd) steps.iterations = 10, steps.substeps = 50; // gradients turn
    const cases::Solution rest = msm::come_to_rest(scene, springs, 1);
    CHECK(apart(rest.displacement, equilibrium) < 1e-3); // up to what a node creeps by unseen
  }
}

TEST_CASE("a body that does not come to rest in its time says so") {
  cases::Scene scene = bar(StepMethod::implicit_euler, 10, sideways);
  scene.definition.dynamics.reset();
  scene.definition.msm.real_time->end = 0.2;
  CHECK_THROWS_WITH(msm::come_to_rest(scene, {springs_of_cells}, 1),
                    Catch::Contains("within 0.2 s: rest is 0.5 s without motion"));
  scene.definition.msm.real_time->end = 0.6; // it was let go at the first's start
  CHECK_THROWS_WITH(msm::come_to_rest(scene, {springs_of_cells}, 1),
                    Catch::Contains("does not come to rest within 0.6 s: in the last 0.5 s a node moved by"));
}
