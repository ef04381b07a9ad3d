// Bodies whose supports move with the load factor.

#include "cases/case/error.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using Eigen::Vector3d;
using msm::Model;
using msm::Path;

namespace {

const double pi = std::acos(-1.0);
using bodies::thesis_cell;

cases::Moved shifted(const std::string& region, const Vector3d& by) {
  cases::Moved moved;
  moved.region = bodies::region(region);
  moved.displacement = by;
  return moved;
}

cases::Moved turned(const std::string& region, double angle, const Vector3d& axis, const Vector3d& centre) {
  cases::Moved moved;
  moved.region = bodies::region(region);
  moved.angle = angle;
  moved.axis = axis;
  moved.centre = centre;
  return moved;
}

cases::Scene moved_scene(const std::array<int, 3>& cells, const std::vector<cases::Moved>& moved) {
  cases::Case definition = bodies::clamped_box(cells, {});
  definition.moved = moved;
  return cases::make_scene(definition);
}

} // namespace

TEST_CASE("a lattice both of whose ends are turned alike turns as a rigid body, half a turn far") {
  const Vector3d axis = Vector3d(1, 2, 2) / 3, centre(1, 2, 3);
  cases::Case definition = bodies::clamped_box({3, 3, 4}, {});
  definition.fixed.clear();
  definition.moved = {turned("z-", 180, axis, centre), turned("z+", 180, axis, centre)};
  const cases::Scene scene = cases::make_scene(definition);
  for (const Path path : {Path::direct, Path::multigrid}) {
    const cases::Solution found = Model(scene, {thesis_cell}, {path, 1}).solve();
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(pi, axis).toRotationMatrix();
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      const Vector3d arm = scene.mesh.nodes[n] - centre;
      // mm: forces of 1e-9 N (without reactions nothing scales the residual) over 0.01 N/mm
      CHECK((arm + found.displacement[n] - turn * arm).norm() < 1e-6);
    }
    CHECK(found.inverted_cells == 0);
    CHECK(found.load_reached == 1);
  }
}

TEST_CASE("a body pressed by its top takes the shape that the load of the same height gives it",
          "[verification]") {
  // One cell between symmetry planes, its top free to slide: a dead load and its displacement are the same.
  cases::Case loaded = bodies::clamped_box({1, 1, 1}, bodies::tensile(-0.01));
  loaded.fixed = {{bodies::region("x-"), {true, false, false}},
                  {bodies::region("y-"), {false, true, false}},
                  {bodies::region("z-"), {false, false, true}}};
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-12;
  const cases::Solution by_load = Model(cases::make_scene(loaded), {bodies::hybrid_cell}).solve(settings);
  cases::Case moved = loaded;
  moved.loads.clear();
  moved.moved = {shifted("z+", {0, 0, by_load.displacement.back().z()})};
  moved.moved[0].components = {false, false, true};
  const cases::Solution by_hand = Model(cases::make_scene(moved), {bodies::hybrid_cell}).solve(settings);
  CHECK(largest_difference(by_load, by_hand) < 1e-10); // mm, as asked; residual 1e-12
}

TEST_CASE("the multigrid path and the direct path carry a moved top to the same equilibrium",
          "[verification]") {
  mechanics::EquilibriumSettings tight;
  tight.tolerance = 1e-11; // so that what differs is not the residual
  tight.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  const std::vector<cases::Moved> motions = {shifted("z+", {0.5, 0, -1}),
                                             turned("z+", 60, Vector3d::UnitZ(), {3, 3, 6})};
  msm::CellStiffness softening = bodies::hybrid_cell, stiffening = softening;
  softening.exponents = {-1.3, -1.8, -2.2};
  stiffening.exponents = {1.8, 1.8, 1.8};
  for (const cases::Moved& motion : motions)
    for (const msm::CellStiffness& stiffness : {thesis_cell, bodies::hybrid_cell, softening, stiffening}) {
      const cases::Scene scene = moved_scene({6, 6, 6}, {motion});
      const cases::Solution direct = Model(scene, {stiffness}, {Path::direct, 1}).solve(tight);
      const cases::Solution multigrid = Model(scene, {stiffness}, {Path::multigrid, 1}).solve(tight);
      CHECK(largest_difference(direct, multigrid) < 1e-8); // mm
      CHECK(multigrid.lowest_eigenvalue.value() ==
            Approx(direct.lowest_eigenvalue.value()).epsilon(0.01)); // 3 digits
      CHECK(multigrid.residual <= 1e-11);
      CHECK(direct.residual <= 1e-11);
    }
}

TEST_CASE("what is moved arrives, whether the body turns by a quarter turn or is also loaded") {
  const std::vector<cases::Moved> motion = {turned("z+", 90, Vector3d::UnitZ(), {2, 2, 4})};
  cases::Case definition = bodies::clamped_box({4, 4, 4}, {bodies::nodal_force("x+", {0.001, 0, 0})});
  definition.moved = motion;
  const cases::Scene scene = cases::make_scene(definition);
  const cases::Solution found = Model(scene, {thesis_cell}).solve();
  REQUIRE(scene.moved[0].selection.nodes.size() == 25);
  for (const int n : scene.moved[0].selection.nodes) {
    const auto node = static_cast<std::size_t>(n);
    const Vector3d rest = scene.mesh.nodes[node];
    CHECK((rest + found.displacement[node] - Vector3d(4 - rest.y(), rest.x(), 4)).norm() < 1e-12); // rounding
  }
  CHECK(found.residual <= 1e-9);
}

TEST_CASE("a bar follows its end through most of a turn and a whole one, whatever solver leads it") {
  // Where the end arrives after 300 degrees, it arrives after -60 too, and after 360 it has not moved.
  for (const double angle : {300., 360.}) {
    cases::Case definition = bodies::clamped_box({2, 2, 12}, {});
    definition.moved = {turned("z+", angle, Vector3d::UnitZ(), {1, 1, 12})};
    for (const auto solver : {cases::Solver::newton, cases::Solver::lbfgs, cases::Solver::fire})
      for (const Path path : {Path::direct, Path::multigrid}) {
        definition.msm.solver = solver;
        const cases::Scene scene = cases::make_scene(definition);
        mechanics::EquilibriumSettings settings;
        settings.tolerance = 1e-5;
        const cases::Solution found = Model(scene, {thesis_cell}, {path, 1}).solve(settings);
        cases::Region corner;
        corner.near = Vector3d(2, 1, 3); // a quarter of the way up
        const auto node = static_cast<std::size_t>(cases::select_node(scene.mesh, corner));
        const Vector3d arm = scene.mesh.nodes[node] + found.displacement[node] - Vector3d(1, 1, 3);
        INFO(angle << " degrees, " << cases::name_of(solver));
        CHECK(std::atan2(arm.y(), arm.x()) * 180 / pi == Approx(angle / 4).margin(5)); // the ends are warped
        CHECK(found.inverted_cells == 0);
        CHECK(found.load_reached == 1);
      }
  }
}

TEST_CASE("a node that one region holds and another moves is refused") {
  CHECK_THROWS_AS(moved_scene({2, 2, 2}, {shifted("x+", {0.1, 0, 0})}), cases::InputError);
  CHECK_NOTHROW(moved_scene({2, 2, 2}, {shifted("z+", {0.1, 0, 0})}));
}

TEST_CASE("a solve that is told to stop ends at once, with the load it has reached") {
  const cases::Scene scene = moved_scene({3, 3, 3}, {shifted("z+", {0, 0, -0.5})});
  mechanics::EquilibriumSettings settings;
  settings.largest_load_step = settings.first_load_step = 0.25;
  int asked = 0;
  settings.should_stop = [&] { return ++asked > 5; };
  try {
    Model(scene, {thesis_cell}).solve(settings);
    FAIL("an equilibrium was reported");
  } catch (const cases::SolveError& error) {
    CHECK(asked == 6);
    CHECK(error.so_far().newton_iterations == 5);
    CHECK(error.load_reached() < 1);
    CHECK(error.residual() <= 1e-9); // the last equilibrium's
    CHECK(error.outcome() == cases::Outcome::unknown);
  }
  settings.should_stop = {};
  settings.max_newton_iterations = 3;
  CHECK_THROWS_WITH(Model(scene, {thesis_cell}).solve(settings),
                    Catch::Contains("limit on Newton iterations"));
}
