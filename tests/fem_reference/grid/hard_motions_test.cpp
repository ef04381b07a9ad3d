// Motions of finite elements that are hard to follow.

#include "fem_reference/model.hpp"

#include "tests/fem_reference/grid/moving_block.hpp"
#include "tests/support/largest.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using cases::Element;
using Eigen::Vector3d;
using fem_reference::Backend;
using scenes::block;
using scenes::region;

namespace hard_motions {

namespace {

cases::Solution follow(const cases::Case& definition, Backend backend) {
  return fem_reference::follow(cases::make_scene(definition), fem_reference::default_steps(), backend);
}

} // namespace

TEST_CASE("strong damping ends in the static equilibrium, on the grid too", "[verification]") {
  for (const auto element : {Element::q1, Element::q1_bbar}) {
    CAPTURE(cases::name_of(element));
    cases::Case definition = block(cases::Formulation::log_strain, element);
    definition.material_dynamics = {1000., 100, 0.01};
    definition.dynamics->scheme.scheme = cases::Scheme::implicit_euler;
    definition.dynamics->step = 0.05; // s; the period is about 0.08 s
    definition.dynamics->end = 5;
    const cases::Solution motion = follow(definition, Backend::grid);
    definition.dynamics.reset();
    const cases::Solution still =
        fem_reference::Model(cases::make_scene(definition), MPI_COMM_SELF, Backend::grid).solve();
    CHECK(largest_displacement(still) > 0.1);
    CHECK(largest_difference(motion, still) <= 1e-6 * largest_displacement(still));
  }
}

TEST_CASE("steps far beyond the period are solved, and forget it", "[verification]") {
  for (const auto scheme : {cases::Scheme::implicit_euler, cases::Scheme::bdf2}) {
    CAPTURE(cases::name_of(scheme));
    cases::Case definition = block(cases::Formulation::log_strain, Element::q1_bbar);
    definition.dynamics->scheme.scheme = scheme;
    definition.dynamics->step = 100; // a thousand periods
    definition.dynamics->end = 1000;
    const cases::Solution motion = follow(definition, Backend::grid);
    definition.dynamics.reset();
    const cases::Solution still =
        fem_reference::Model(cases::make_scene(definition), MPI_COMM_SELF, Backend::grid).solve();
    CHECK(largest_difference(motion, still) <= 1e-6 * largest_displacement(still));
  }
}

TEST_CASE("stiffnesses that differ by six orders move as the assembled backend says", "[verification]") {
  cases::Case definition = block(cases::Formulation::log_strain, Element::q1);
  cases::RegionMaterial stiff;
  stiff.material = cases::LinearElastic{4000, 0.3};
  stiff.dynamics = {2000., 0, 0};
  stiff.lower = Vector3d(-INFINITY, -INFINITY, 7);
  stiff.upper = Vector3d(INFINITY, INFINITY, INFINITY);
  definition.region_materials = {stiff};
  definition.dynamics->scheme.scheme = cases::Scheme::generalized_alpha;
  const cases::Solution motion = follow(definition, Backend::automatic),
                        assembled = follow(definition, Backend::assembled);
  CHECK(largest_displacement(assembled) > 0.1);
  // Tolerance: residuals of 1e-10 of the forces in the stiff part, whose lever is the soft one.
  CHECK(largest_difference(motion, assembled) <= 1e-5 * largest_displacement(assembled));
}

TEST_CASE("a body that nothing holds is set spinning by a torque, and both backends turn it alike",
          "[verification]") {
  cases::Case definition = block(cases::Formulation::log_strain, Element::q1_bbar);
  definition.fixed.clear();
  cases::Load torque{region("z+"), cases::loads::Torque{2e-3, Eigen::Vector3d::UnitZ(), Vector3d(4, 3, 12)}};
  torque.history.points = {{{0., 1.}}, {{0.05, 1.}}, {{0.05, 0.}}};
  definition.loads = {torque};
  definition.dynamics->scheme = {cases::Scheme::generalized_alpha, 0.25, 0.5, 1};
  definition.dynamics->end = 0.2;
  const cases::Solution assembled = follow(definition, Backend::assembled),
                        grid = follow(definition, Backend::grid);
  CHECK(largest_displacement(grid) > 3); // a corner is 5 mm from the axis
  CHECK(largest_difference(grid, assembled) <= 1e-6 * largest_displacement(assembled));
  Vector3d sum = Vector3d::Zero(); // the centre of mass stays: lumped masses of corners, edges, faces
  const cases::Mesh mesh = cases::make_scene(definition).mesh;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (const int node : mesh.cells[c]) sum += grid.displacement[cases::index(node)];
  CHECK(sum.norm() <= 1e-8 * double(8 * mesh.cells.size()));
}

TEST_CASE("a column that snaps sideways is followed where statics finds no equilibrium", "[verification]") {
  cases::Case definition = block(cases::Formulation::log_strain, Element::q1_bbar);
  definition.body = cases::Box{Vector3d(4, 4, 24), {2, 2, 12}};
  definition.material = cases::LinearElastic{0.1, 0.3};
  definition.material_dynamics = {1000., 5, 0.001};
  // Euler's load over the area is pi²/12 E (4/48)² = 5.7e-4 MPa
  definition.loads = {scenes::traction("z+", {0, 0, -1.5e-3}), scenes::traction("x-", {1e-6, 0, 0})};
  definition.loads[0].history.points = {{{0., 0.}}, {{0.05, 1.}}};
  definition.dynamics->step = 0.005;
  definition.dynamics->end = 0.5;
  const cases::Solution assembled = follow(definition, Backend::assembled),
                        grid = follow(definition, Backend::grid);
  CHECK(largest_displacement(grid) > 5);
  CHECK(grid.inverted_cells == 0);
  // Tolerance: the way down multiplies what residuals leave.
  CHECK(largest_difference(grid, assembled) <= 1e-4 * largest_displacement(assembled));
}

TEST_CASE("a step that is too long for Newton's method is halved, and the motion goes on") {
  cases::Case definition = block(cases::Formulation::log_strain, Element::q1_bbar);
  definition.loads = {scenes::traction("z+", {1e-3, 0, 0})}; // a quarter of its modulus at once
  definition.dynamics->step = 0.01;
  definition.dynamics->end = 0.04;
  for (const auto backend : {Backend::assembled, Backend::grid}) {
    const cases::Solution motion = follow(definition, backend);
    CAPTURE(int(backend), largest_displacement(motion));
    CHECK(motion.trajectory->halved_steps > 0);
    CHECK(std::isfinite(largest_displacement(motion)));
    CHECK(motion.trajectory->time.size() == 5);
  }
}

} // namespace hard_motions
