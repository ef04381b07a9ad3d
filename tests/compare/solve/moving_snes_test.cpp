#include "cases/case/error.hpp"
#include "cases/scene/masses.hpp"
#include "msm/cell_terms.hpp"
#include "msm/snes/motion.hpp"
#include "tests/msm/moving_bodies.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/with_mpi.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <petscsys.h>

// On one rank by itself; on two under mpirun (compare/snes_on_two_ranks).

namespace moving_bodies {

namespace {

const msm::CellStiffness power_log{0.2, 0.1, 0.3, 0.05, msm::Exponents{-1.3, -1.8, -2.2}};
constexpr cases::MaterialDynamics damped{1000., 3, 0.0005}, undamped{1000., 0, 0};

/// So that what is compared is the motions, not where the solvers stop.
mechanics::IntegrationSettings tight() {
  mechanics::IntegrationSettings settings;
  settings.newton.tolerance = 1e-12;
  return settings;
}

/// A block whose ends move and turn, under gravity that bends it by a third of its height; all of it is seen.
cases::Scene driven_block(cases::Scheme scheme) {
  cases::Scene scene = turned_block(steps(scheme, 0.002, 0.02), damped);
  const cases::loads::Gravity pull{{0, 1500, -3000}}; // m/s²
  scene.loads.push_back({{}, {{}, pull, {{{0., 0.}, {0.005, 1.}}}}});
  scene.definition.measures = {{"", cases::measures::Volume{}}};
  return scene;
}

cases::Solution follow_by_snes(const cases::Scene& scene, const msm::CellStiffness& cell,
                               const mechanics::IntegrationSettings& settings = tight(),
                               MPI_Comm communicator = PETSC_COMM_WORLD) {
  return msm::follow_lattice_by_snes(scene, msm::make_lattice(scene.mesh, {cell}),
                                     msm::damping_lattice(scene, std::vector{cell}), communicator, settings);
}

cases::Solution follow_directly(const cases::Scene& scene, const msm::CellStiffness& cell,
                                const mechanics::IntegrationSettings& settings = tight()) {
  return msm::follow(scene, msm::make_lattice(scene.mesh, {cell}),
                     msm::damping_lattice(scene, std::vector{cell}), settings);
}

double size_of(const cases::Trajectory& motion) {
  double size = 0;
  for (const auto& body : motion.bodies)
    for (const Vector3d& u : body.displacement) size = larger(size, u.norm());
  return size;
}

/// Largest difference of two motions' displacements over the size of the second; NaN if a number is.
double difference(const cases::Solution& a, const cases::Solution& b) {
  const auto &one = a.trajectory.value().bodies, &other = b.trajectory.value().bodies;
  if (one.size() != other.size()) throw std::invalid_argument("not of one motion");
  double largest = 0;
  for (std::size_t i = 0; i < one.size(); ++i)
    largest = larger(largest, largest_difference(one[i].displacement, other[i].displacement,
                                                 [](const auto& u) { return u.norm(); }));
  return largest / size_of(*b.trajectory);
}

} // namespace

TEST_CASE_METHOD(WithMpi, "SNES moves a body as the direct path does, by every scheme",
                 "[snes][verification][long]") {
  const auto [scheme, cell] =
      GENERATE(table<cases::Scheme, msm::CellStiffness>({{cases::Scheme::implicit_euler, power_log},
                                                         {cases::Scheme::newmark, hybrid_springs},
                                                         {cases::Scheme::generalized_alpha, power_log},
                                                         {cases::Scheme::bdf2, hybrid_springs}}));
  INFO(cases::name_of(scheme));
  const cases::Scene scene = driven_block(scheme);
  const cases::Solution direct = follow_directly(scene, cell), general = follow_by_snes(scene, cell);
  const cases::Trajectory &seen = *general.trajectory, &expected = *direct.trajectory;
  REQUIRE(size_of(expected) > 5); // mm, of cells of 10 mm
  CHECK(seen.time == expected.time);
  CHECK(difference(general, direct) <= 1e-8); // steps are solved to 1e-12, ten of them
  REQUIRE(seen.volume.size() == expected.volume.size());
  for (std::size_t i = 0; i < seen.volume.size(); ++i)
    CHECK(seen.volume[i] == Approx(expected.volume[i]).epsilon(1e-8)); // as displacements
  // What the ranks share is the end of the trajectory that each has.
  CHECK(largest_difference(direct, general) <= 1e-8 * size_of(expected));
  CHECK(largest_volume_difference(direct, general) <= 1e-8 * 1000); // of cells of 1000 mm³
  CHECK(general.unknowns == direct.unknowns);
  CHECK(general.inverted_cells == direct.inverted_cells);
}

TEST_CASE_METHOD(WithMpi, "SNES in time with algebraic multigrid follows the same motion",
                 "[snes][verification][long]") {
  const cases::Scene scene = driven_block(cases::Scheme::generalized_alpha);
  const cases::Solution factorised = follow_by_snes(scene, hybrid_springs);
  PetscOptionsSetValue(nullptr, "-msm_ksp_type", "cg");
  PetscOptionsSetValue(nullptr, "-msm_pc_type", "gamg");
  PetscOptionsSetValue(nullptr, "-msm_snes_ksp_ew", nullptr);
  const cases::Solution iterated = follow_by_snes(scene, hybrid_springs);
  for (const char* option : {"-msm_ksp_type", "-msm_pc_type", "-msm_snes_ksp_ew"})
    PetscOptionsClearValue(nullptr, option);
  CHECK(factorised.factorisations > 0);
  CHECK(iterated.factorisations == 0);
  CHECK(iterated.linear_iterations > iterated.newton_iterations);
  CHECK(iterated.trajectory->halved_steps == 0);
  CHECK(difference(iterated, factorised) <= 1e-8); // as against the direct path
}

TEST_CASE_METHOD(WithMpi, "a motion by SNES is the same on any number of ranks",
                 "[snes][verification][long]") {
  cases::Scene scene = driven_block(cases::Scheme::newmark);
  scene.definition.dynamics->start = cases::MotionStart::equilibrium;
  scene.loads.front().load.history.points = {{0., 1.}, {0., 0.2}}; // most of the weight is taken at time 0
  const cases::Solution together = follow_by_snes(scene, power_log),
                        alone = follow_by_snes(scene, power_log, tight(), PETSC_COMM_SELF),
                        direct = follow_directly(scene, power_log);
  CHECK(difference(together, alone) <= 1e-9); // sums are rounded in another order, steps solved to 1e-12
  CHECK(together.newton_iterations == alone.newton_iterations);
  CHECK(together.trajectory->halved_steps == alone.trajectory->halved_steps);
  CHECK(difference(alone, direct) <= 1e-8);
  REQUIRE(size_of({{}, {}, {}, {}, {direct.trajectory->bodies.front()}}) > 1); // mm: it begins deformed
}

TEST_CASE_METHOD(WithMpi, "SNES moves cells of terms and networks, with a node that no spring holds",
                 "[snes][verification]") {
  cases::Scene scene = block(steps(cases::Scheme::bdf2, 0.002, 0.02), damped, false, 3);
  const msm::BodyTerms terms{{msm::terms_of(hybrid_springs)}, {}, msm::Boundary::whole};
  const auto compare = [&](const msm::Lattice& lattice, const msm::Lattice& damping) {
    const cases::Solution direct = msm::follow(scene, lattice, damping, tight()),
                          general =
                              msm::follow_lattice_by_snes(scene, lattice, damping, PETSC_COMM_WORLD, tight());
    CHECK(difference(general, direct) <= 1e-8); // as of cells of four stiffnesses
  };
  compare(msm::make_lattice(scene.mesh, terms), msm::damping_lattice(scene, terms));
  msm::Lattice network = msm::make_lattice(scene.mesh, {hybrid_springs});
  network.volume_cells.clear();
  const int alone = static_cast<int>(scene.mesh.nodes.size()) - 1; // of z+
  network.links.erase(std::remove_if(network.links.begin(), network.links.end(),
                                     [&](const msm::Link& link) { return link.j == alone; }),
                      network.links.end());
  compare(network, msm::damping_lattice(scene, network));
}

TEST_CASE_METHOD(WithMpi, "a body on which nothing acts stays where it is under SNES", "[snes]") {
  cases::Scene scene = block(steps(cases::Scheme::newmark, 0.002, 0.006), undamped, false, 3);
  scene.loads.clear();
  const cases::Solution still = follow_by_snes(scene, hybrid_springs);
  CHECK(size_of(*still.trajectory) == 0);
  CHECK(still.trajectory->halved_steps == 0);
}

TEST_CASE_METHOD(WithMpi, "SNES keeps the energy of a small undamped swing by newmark",
                 "[snes][verification]") {
  cases::Scene scene = block(steps(cases::Scheme::newmark, 0.0005, 0.1), undamped, false, 3);
  scene.loads.front().load.scale(1e-3); // strains of 1e-5, so that the springs are linear to that
  const cases::Solution motion = follow_by_snes(scene, hybrid_springs, {});
  const msm::Lattice lattice = msm::make_lattice(scene.mesh, {hybrid_springs});
  const std::vector<double> mass = msm::make_inertia(scene, {}).mass;
  // Without the trajectory's velocities: v1 = 2 (u1 - u0)/h - v0 of (1/4, 1/2).
  const auto& bodies = motion.trajectory->bodies;
  REQUIRE(bodies.size() == 201);
  const double h = scene.definition.dynamics->step;
  const Vector3d acceleration = cases::acceleration_of(scene.loads.front().load);
  msm::Points velocity(mass.size(), Vector3d::Zero());
  double largest = 0, largest_change = 0; // N mm
  for (std::size_t i = 1; i < bodies.size(); ++i) {
    const msm::Points &u = bodies[i].displacement, &before = bodies[i - 1].displacement;
    double kinetic = 0, of_loads = 0;
    for (std::size_t p = 0; p < u.size(); ++p) {
      velocity[p] = 2 / h * (u[p] - before[p]) - velocity[p];
      kinetic += mass[p] * velocity[p].squaredNorm() / 2;
      of_loads -= mass[p] * acceleration.dot(u[p]);
    }
    largest = larger(largest, kinetic);
    largest_change = larger(largest_change, std::abs(kinetic + of_loads + msm::energy_at(lattice, u)));
  }
  REQUIRE(largest > 0);
  CHECK(largest_change <= 1e-6 * largest); // a tenth of the strains, by which springs are not linear
}

TEST_CASE_METHOD(WithMpi, "a step that SNES leaves with no more than rounding is solved", "[snes]") {
  // With these steps the last digit of a displacement is 1e-10 of the loads, times mass over the step
  // squared.
  cases::Scene scene = block(steps(cases::Scheme::newmark, 1e-6, 5e-6), undamped, false, 3);
  scene.definition.dynamics->start = cases::MotionStart::equilibrium;
  scene.loads.front().load.history.points = {{0., 1.}, {0., 0.}};
  const cases::Solution motion = follow_by_snes(scene, hybrid_springs, tight());
  CHECK(motion.trajectory->halved_steps == 0);
  CHECK(motion.trajectory->largest_residual > tight().newton.tolerance);
  CHECK(motion.trajectory->largest_residual <= 1e-6); // what Newton's method here takes for rounding at most
}

TEST_CASE_METHOD(WithMpi, "a step that SNES does not solve is halved, and the motion goes on", "[snes]") {
  // It begins with a hundred times its weight, of which nothing is left after three steps.
  cases::Scene scene = block(steps(cases::Scheme::implicit_euler, 0.01, 0.05), {1000., 0, 0.002}, false, 3);
  scene.loads.front().load.scale(100);
  scene.loads.front().load.history.points = {{0., 1.}, {0.03, 0.}};
  mechanics::IntegrationSettings few = tight();
  few.newton.tolerance = 1e-9;
  few.newton.max_newton_per_step = 3;
  const cases::Solution halved = follow_by_snes(scene, power_log, few),
                        whole = follow_by_snes(scene, power_log);
  CHECK(halved.trajectory->halved_steps > 0);
  CHECK(halved.trajectory->halved_steps ==
        follow_by_snes(scene, power_log, few, PETSC_COMM_SELF).trajectory->halved_steps);
  CHECK(whole.trajectory->halved_steps == 0);
  CHECK(halved.trajectory->time == whole.trajectory->time);
  scene.definition.dynamics->step /= 10;
  scene.definition.dynamics->write_every = 10;
  const cases::Solution fine = follow_by_snes(scene, power_log);
  CHECK(difference(halved, fine) < difference(whole, fine));
}

TEST_CASE_METHOD(WithMpi, "a step that goes too far for its iterations is halved, on all ranks alike",
                 "[snes]") {
  cases::Scene scene = turned_block(steps(cases::Scheme::implicit_euler, 0.005, 0.015), damped);
  scene.moved[0].motion.displacement.setZero();
  scene.moved[1].motion.angle = 120; // degrees, in the first step: the body goes along on straight lines
  scene.moved[1].motion.history.points = {{0., 0.}, {0.005, 1.}};
  mechanics::IntegrationSettings few = tight();
  few.newton.max_newton_per_step = 5;
  const cases::Solution motion = follow_by_snes(scene, power_log, few),
                        alone = follow_by_snes(scene, power_log, few, PETSC_COMM_SELF);
  CHECK(motion.trajectory->halved_steps > 0);
  CHECK(motion.trajectory->halved_steps == alone.trajectory->halved_steps);
  CHECK(difference(motion, alone) <= 1e-9); // as with whole steps
  CHECK(motion.inverted_cells == 0);
}

TEST_CASE_METHOD(WithMpi, "a motion that SNES cannot follow says how far it came", "[snes]") {
  const cases::Scene scene = block(steps(cases::Scheme::newmark, 0.001, 0.02), undamped, false, 3);
  mechanics::IntegrationSettings settings;
  settings.newton.max_newton_per_step = 0;
  CHECK_THROWS_WITH(follow_by_snes(scene, hybrid_springs, settings), Catch::Contains("motion, after 0 s"));
  settings = {};
  settings.newton.should_stop = [] { return true; };
  CHECK_THROWS_WITH(follow_by_snes(scene, hybrid_springs, settings), Catch::Contains("it was stopped"));
}

} // namespace moving_bodies
