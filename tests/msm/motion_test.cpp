
#include "cases/case/error.hpp"
#include "msm/direct/direct_system.hpp"
#include "msm/model.hpp"
#include "msm/moving_springs.hpp"
#include "tests/mechanics/dynamics/manufactured_motion.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;

namespace {

const std::vector<msm::CellStiffness> springs_of_all{{0.2, 0.1, 0.3, 0.05}}; // N/mm, MPa

cases::Load gravity_in_time(std::vector<std::array<double, 2>> history) {
  cases::Load load{{}, cases::loads::Gravity{{0, 0, -9.81}}};
  load.history.points = std::move(history);
  return load;
}

/// A bar of 3 x 1 x 1 cells of 10 mm, of water, held at one end; its tip and its volume are watched.
cases::Scene bar(const cases::Load& load, const cases::Dynamics& dynamics,
                 const cases::MaterialDynamics& material) {
  cases::Case definition;
  definition.body = cases::Box{{30, 10, 10}, {3, 1, 1}};
  definition.fixed.push_back({cases::Region{"x-"}, {true, true, true}});
  definition.material_dynamics = material;
  definition.measures = {{"", cases::measures::Displacement{{"x+ y+ z+"}}}, {"", cases::measures::Volume{}}};
  cases::Scene scene = cases::make_scene(definition);
  scene.loads.push_back({{}, load});
  scene.definition.dynamics = dynamics;
  return scene;
}

cases::Dynamics dynamics_of(cases::Scheme scheme, double step, double end, cases::MotionStart start) {
  cases::Dynamics dynamics;
  dynamics.scheme.scheme = scheme;
  dynamics.step = step;
  dynamics.end = end;
  dynamics.start = start;
  dynamics.write_every = 4;
  return dynamics;
}

cases::Solution follow(const cases::Scene& scene, const mechanics::IntegrationSettings& settings = {}) {
  return msm::follow(scene, springs_of_all, {msm::Path::direct, 1, {}, {}}, settings);
}

/// Equilibrium of the static scene.
cases::Solution equilibrium(cases::Scene scene) {
  scene.definition.dynamics.reset();
  return msm::Model(scene, springs_of_all, {msm::Path::direct}).solve();
}

double largest_difference(const msm::Points& a, const msm::Points& b) {
  double largest = 0;
  for (std::size_t p = 0; p < a.size(); ++p) largest = larger(largest, (a[p] - b[p]).norm());
  return largest;
}

const cases::MaterialDynamics undamped{1000., 0, 0, {}};

} // namespace

TEST_CASE("springs that start in equilibrium stay where they are", "[verification]") {
  for (const auto scheme : {cases::Scheme::newmark, cases::Scheme::bdf2}) {
    const cases::Scene scene =
        bar(gravity_in_time({}), dynamics_of(scheme, 0.001, 0.02, cases::MotionStart::equilibrium), undamped);
    const cases::Solution motion = follow(scene), still = equilibrium(scene);
    const double size = still.displacement.back().norm();
    CHECK(size > 0.1);
    CHECK(largest_difference(motion.displacement, still.displacement) <= 1e-6 * size);
  }
}

TEST_CASE("what is watched of a motion is there for every step, the whole body for every fourth") {
  const cases::Scene scene =
      bar(gravity_in_time({{0., 1.}, {0., 0.}}),
          dynamics_of(cases::Scheme::newmark, 0.001, 0.01, cases::MotionStart::equilibrium), undamped);
  const cases::Solution motion = follow(scene);
  CHECK(motion.status == cases::Status::converged);
  REQUIRE(motion.trajectory);
  const cases::Trajectory& seen = *motion.trajectory;
  REQUIRE(seen.time.size() == 11);
  CHECK(seen.time.front() == 0);
  CHECK(seen.time.back() == Approx(0.01).epsilon(1e-14));
  REQUIRE(seen.nodes.size() == 1);
  CHECK(seen.displacement.size() == 11);
  CHECK(seen.volume.size() == 11);
  std::vector<int> steps;
  for (const auto& body : seen.bodies) steps.push_back(body.step);
  CHECK(steps == std::vector<int>{0, 4, 8, 10});
  const auto tip = cases::index(seen.nodes.front());
  CHECK(seen.bodies.back().displacement[tip] == seen.displacement.back());
  CHECK(motion.displacement[tip] == seen.displacement.back());
  // Released from its weight, the tip starts where gravity held it, and rises.
  CHECK((seen.displacement.front() - equilibrium(scene).displacement[tip]).norm() <
        1e-6 * seen.displacement.front().norm());
  CHECK(seen.displacement.back().z() > seen.displacement.front().z());
}

TEST_CASE("strongly damped springs end in their static equilibrium", "[verification]") {
  const cases::Scene scene =
      bar(gravity_in_time({}), dynamics_of(cases::Scheme::implicit_euler, 0.1, 30, cases::MotionStart::rest),
          {1000., 60, 0.2});
  const cases::Solution motion = follow(scene), still = equilibrium(scene);
  CHECK(largest_difference(motion.displacement, still.displacement) <=
        1e-6 * still.displacement.back().norm());
}

TEST_CASE("a support that moves takes damped springs along", "[verification]") {
  cases::Case definition =
      bar(gravity_in_time({}), dynamics_of(cases::Scheme::implicit_euler, 0.05, 10, cases::MotionStart::rest),
          {1000., 200, 0.05})
          .definition;
  definition.fixed.clear();
  cases::Moved moved;
  moved.region = cases::Region{"x-"};
  moved.displacement = {0.5, 0, 1};
  moved.history.points = {{0., 0.}, {0.1, 1.}};
  definition.moved.push_back(moved);
  const cases::Dynamics dynamics = *definition.dynamics;
  definition.dynamics.reset(); // no gravity either: of the definition it has none
  cases::Scene scene = cases::make_scene(definition);
  scene.definition.dynamics = dynamics;
  const cases::Solution motion = follow(scene);
  for (const Vector3d& u : motion.displacement) CHECK((u - moved.displacement).norm() <= 1e-6);
  CHECK(motion.trajectory->displacement[1].z() < 0.5); // half of the ramp's way
}

TEST_CASE("springs follow a step far beyond their period to where statics are", "[verification]") {
  for (const auto scheme : {cases::Scheme::implicit_euler, cases::Scheme::bdf2}) {
    INFO(cases::name_of(scheme));
    const cases::Scene scene =
        bar(gravity_in_time({}), dynamics_of(scheme, 1000, 20000, cases::MotionStart::rest), undamped);
    const cases::Solution motion = follow(scene), still = equilibrium(scene);
    CHECK(largest_difference(motion.displacement, still.displacement) <=
          1e-6 * still.displacement.back().norm());
  }
}

TEST_CASE("springs' error in time falls at the order of each scheme", "[verification]") {
  cases::Scene scene = bar(gravity_in_time({}), {}, {1000., 3, 0.001});
  msm::Problem problem = msm::make_moving_problem(scene);
  problem.lattice = msm::make_lattice(scene.mesh, springs_of_all);
  const auto statics = msm::make_direct_system(problem);
  const msm::SpringBody damping = msm::damping_springs(scene, springs_of_all);
  const auto motion = msm::make_moving_lattice(
      problem, *statics, msm::make_inertia(scene, msm::make_lattice(scene.mesh, damping)));
  msm::Points shape(scene.mesh.nodes.size(), Vector3d::Zero()); // bends and stretches finitely
  for (std::size_t n = 0; n < shape.size(); ++n) {
    const double along = scene.mesh.nodes[n].x() / 30;
    shape[n] = along * along * Vector3d{0.3, -0.4, 0.6};
  }
  check_orders(*motion, to_vector(problem, shape), 1600);
}

TEST_CASE("a motion that cannot be followed says how far it came") {
  const cases::Scene scene =
      bar(gravity_in_time({}), dynamics_of(cases::Scheme::newmark, 0.001, 0.02, cases::MotionStart::rest),
          undamped);
  mechanics::IntegrationSettings settings;
  settings.newton.max_newton_per_step = 0;
  CHECK_THROWS_WITH(follow(scene, settings), Catch::Contains("motion, after 0 s"));
}

TEST_CASE("a body without unknowns goes where its supports go") {
  cases::Scene scene =
      bar(gravity_in_time({}), dynamics_of(cases::Scheme::newmark, 0.01, 0.1, cases::MotionStart::rest),
          {1000., 1, 0.001});
  scene.mesh = cases::make_box_mesh({10, 10, 10}, {1, 1, 1});
  scene.constrained = {{cases::select(scene.mesh, cases::Region{"x-"}), {true, true, true}},
                       {cases::select(scene.mesh, cases::Region{"x+"}), {true, true, true}}};
  const cases::Solution motion = follow(scene);
  CHECK(motion.status == cases::Status::converged);
  CHECK_FALSE(motion.trajectory->slowest);
  for (const Vector3d& u : motion.displacement) CHECK(u.isZero(0));
}

TEST_CASE("springs under loads near nothing move as under a thousand times as much", "[verification]") {
  // Strains of 1e-13 and less, which positions cannot hold.
  const auto tip = [](double factor) {
    cases::Load load = gravity_in_time({});
    load.scale(factor);
    const cases::Scene scene = bar(
        load, dynamics_of(cases::Scheme::newmark, 0.01, 0.1, cases::MotionStart::rest), {1000., 1, 0.001});
    return follow(scene).trajectory->displacement.back().z() / factor;
  };
  CHECK(tip(1e-9) == Approx(tip(1e-6)).epsilon(1e-6));
  CHECK(tip(1e-12) == Approx(tip(1e-9)).epsilon(1e-6));
}
