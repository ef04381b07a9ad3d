#include "msm/grid/grid_system.hpp"

#include "cases/case/error.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using msm::Model;
using msm::Path;

namespace {

mechanics::EquilibriumSettings tight() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-11; // so that what differs is not the residual
  settings.lowest_eigenvalue = mechanics::LowestEigenvalue::report;
  return settings;
}

void check_agreement(const cases::Scene& scene, const std::vector<msm::CellStiffness>& stiffness) {
  const cases::Solution direct = Model(scene, stiffness, {Path::direct, 1}).solve(tight());
  const cases::Solution multigrid = Model(scene, stiffness, {Path::multigrid, 1}).solve(tight());
  CHECK(largest_difference(direct, multigrid) < 1e-8); // mm, as asked
  CHECK(multigrid.lowest_eigenvalue.value() ==
        Approx(direct.lowest_eigenvalue.value()).epsilon(0.01)); // 3 digits
  CHECK(multigrid.unknowns == direct.unknowns);
}

msm::CellStiffness with_exponents(msm::CellStiffness springs, const msm::Exponents& exponents) {
  springs.exponents = exponents;
  return springs;
}

cases::Scene masked_scene() {
  cases::Grid grid;
  grid.cells = {7, 6, 8};
  for (int k = 0; k < 8; ++k)
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 7; ++i) grid.present.push_back(!(i > 3 && j > 2 && k > 1) && !(i == 2 && j == 2));
  cases::Scene scene;
  scene.definition = bodies::clamped_box({7, 6, 8}, {});
  scene.mesh = cases::make_grid_mesh(grid);
  scene.constrained = {{cases::select(scene.mesh, bodies::region("z-")), {true, true, true}}};
  const cases::Load load = bodies::nodal_force("z+", {0.003, 0.001, 0.01});
  scene.loads = {{cases::select(scene.mesh, load.region), load}};
  return scene;
}

} // namespace

TEST_CASE("the multigrid path and the direct path find the same equilibrium", "[verification]") {
  SECTION("of a cube under large tension") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::tensile(0.05))),
                    {bodies::thesis_cell});
  }
  SECTION("of a box of odd numbers of cells under shear") {
    check_agreement(cases::make_scene(bodies::clamped_box({7, 9, 5}, bodies::shear(0.01))),
                    {bodies::thesis_cell});
  }
  SECTION("of a cube with a cell volume term under torsion") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::torsion(0.025))),
                    {bodies::hybrid_cell});
  }
  SECTION("of a cube of power-log springs under torsion") {
    check_agreement(cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::torsion(0.025))),
                    {with_exponents(bodies::hybrid_cell, {-1.3, -1.8, -2.2})});
  }
  SECTION("of a body with holes") {
    check_agreement(masked_scene(), {bodies::hybrid_cell});
    check_agreement(masked_scene(), {with_exponents(bodies::hybrid_cell, {1.8, 1.8, 1.8})});
  }
  SECTION("of flat cells") {
    cases::Case flat = bodies::clamped_box({12, 12, 8}, bodies::tensile(0.02));
    flat.body = cases::Box{{12, 12, 0.8}, {12, 12, 8}};
    check_agreement(cases::make_scene(flat), {bodies::thesis_cell});
  }
  SECTION("of a cube of two materials") {
    const cases::Scene scene = cases::make_scene(bodies::clamped_box({6, 6, 6}, bodies::tensile(0.02)));
    std::vector<msm::CellStiffness> stiffness;
    for (std::size_t c = 0; c < scene.mesh.cells.size(); ++c)
      stiffness.push_back(c % 6 < 3 ? bodies::thesis_cell : bodies::cell(310, 470, 330));
    check_agreement(scene, stiffness);
  }
}

TEST_CASE("an equilibrium does not depend on the number of threads") {
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({14, 30, 40}, bodies::tensile(0.02)));
  const auto solve = [&](int n_threads) {
    mechanics::EquilibriumSettings settings;
    settings.tolerance = 1e-5; // all that differs is rounding, wherever Newton stops
    return Model(scene, {bodies::cell(31, 47, 33)}, {Path::multigrid, n_threads}).solve(settings);
  };
  CHECK(largest_difference(solve(1), solve(2)) < 1e-9); // mm, as asked
}

TEST_CASE("the multigrid path tells a mechanism and a limit point") {
  const auto outcome = [](const cases::Scene& scene, const msm::CellStiffness& stiffness) {
    try {
      return Model(scene, {stiffness}, {Path::multigrid, 1}).solve().outcome;
    } catch (const cases::SolveError& error) {
      return error.outcome();
    }
  };
  const cases::Scene cube = cases::make_scene(bodies::clamped_box({6, 6, 6}, bodies::tensile(0.02)));
  CHECK(outcome(cube, bodies::cell(31, 47, 33)) == cases::Outcome::stable_equilibrium);
  CHECK(outcome(cube, bodies::cell(31, 0, 0)) == cases::Outcome::mechanism);
  CHECK(outcome(cases::make_scene(bodies::clamped_box({4, 4, 4}, bodies::shear(0.01))),
                bodies::cell(23.3, 6.5, 22.7)) == cases::Outcome::limit_point);
}

TEST_CASE("the multigrid path refuses negative springs, two laws and a body that is no grid") {
  cases::Scene scene = cases::make_scene(bodies::clamped_box({2, 2, 2}, bodies::tensile(0.02)));
  std::vector<msm::CellStiffness> two_laws(8, bodies::thesis_cell);
  two_laws.back().exponents = {-1, -1, -1};
  CHECK_THROWS_AS(Model(scene, two_laws, {Path::multigrid, 1}), cases::InputError);
  CHECK_THROWS_AS(Model(scene, {bodies::cell(31, -4, 33)}, {Path::multigrid, 1}), cases::InputError);
  scene.mesh.grid.reset();
  CHECK_THROWS_AS(Model(scene, {bodies::cell(31, 47, 33)}, {Path::multigrid, 1}), cases::InputError);
}

TEST_CASE("a displacement that is no body's spoils nothing that comes after it") {
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({10, 10, 10}, bodies::tensile(0.01)));
  const std::vector<msm::CellStiffness> springs = {bodies::cell(31, 47, 33)};
  const msm::Problem problem{scene.mesh, {}, cases::loaded_nodes(scene), cases::constrained_dofs(scene)};
  const msm::grid::GridProblem grid = msm::grid::make_grid_problem(problem, springs);
  const auto system = msm::grid::make_grid_system(grid, 1);
  const msm::Vector rest = msm::Vector::Zero(grid.load.size());
  const auto before = system->direction(rest, grid.load, 1, 1e-6, mechanics::Convexity::exact);
  REQUIRE(before);
  msm::Points collapsed; // every point in one place
  for (const Eigen::Vector3d& node : scene.mesh.nodes) collapsed.push_back(-node);
  const msm::Vector nonsense = msm::grid::to_field(problem, grid.body, collapsed);
  for (const double size : {1.0, 1e30}) { // beyond single precision
    const msm::Vector there = size * nonsense;
    system->direction(there, grid.load, 1, 1e-6, mechanics::Convexity::clamped);
    const auto after = system->direction(rest, grid.load, 1, 1e-6, mechanics::Convexity::exact);
    REQUIRE(after);
    CHECK((*after - *before).norm() <
          1e-4 * before->norm()); // 1e-6 of the forces, and how soft the softest is
  }
}
