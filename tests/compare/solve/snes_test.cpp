#include "msm/snes/snes.hpp"

#include "cases/case/error.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/with_mpi.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <petscsys.h>

using namespace springproof;

namespace {

mechanics::EquilibriumSettings tight() {
  mechanics::EquilibriumSettings settings;
  settings.tolerance = 1e-11; // so that what is compared is the answers, not where the solvers stop
  return settings;
}

/// Grids of this size would be solved without a matrix (ranks_test.cpp).
cases::Scene without_its_grid(cases::Scene scene) {
  scene.mesh.grid.reset();
  return scene;
}

const msm::CellStiffness springs = bodies::cell(31, 47, 33), hybrid = bodies::cell(72.2, 11.1, 66.7, 0.148),
                         power_log{0.0722, 0.0111, 0.0667, 0.148, msm::Exponents{-1.3, -1.8, -2.2}};

} // namespace

// Runs on one rank by itself, and on two under mpirun (compare/snes_on_two_ranks).
TEST_CASE_METHOD(WithMpi, "SNES finds the equilibrium that the fast path finds", "[snes][long]") {
  const auto& stiffness = GENERATE(springs, hybrid, power_log);
  for (const cases::Case& body : {bodies::clamped_box({10, 10, 10}, bodies::tensile(0.05)),
                                  bodies::clamped_box({10, 10, 10}, bodies::shear(0.01))}) {
    const cases::Scene scene = cases::make_scene(body);
    const cases::Solution fast = msm::Model(scene, {stiffness}).solve(tight());
    const cases::Solution general =
        msm::solve_by_snes(without_its_grid(scene), {stiffness}, PETSC_COMM_WORLD, tight());
    CHECK(general.outcome == cases::Outcome::stable_equilibrium);
    CHECK(largest_difference(fast, general) <= 1e-8); // mm, of displacements of millimetres
  }
}

TEST_CASE_METHOD(WithMpi, "SNES with algebraic multigrid finds it too", "[snes]") {
  PetscOptionsSetValue(nullptr, "-msm_ksp_type", "cg");
  PetscOptionsSetValue(nullptr, "-msm_pc_type", "gamg");
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({8, 8, 8}, bodies::tensile(0.05)));
  const cases::Solution fast = msm::Model(scene, {springs}).solve(tight());
  const cases::Solution general =
      msm::solve_by_snes(without_its_grid(scene), {springs}, PETSC_COMM_WORLD, tight());
  PetscOptionsClearValue(nullptr, "-msm_ksp_type");
  PetscOptionsClearValue(nullptr, "-msm_pc_type");
  CHECK(general.outcome == cases::Outcome::stable_equilibrium);
  CHECK(general.linear_iterations > general.newton_iterations); // it was not the factorisation
  CHECK(largest_difference(fast, general) <= 1e-8);
}

TEST_CASE_METHOD(WithMpi, "SNES refuses a load beyond the limit point that the fast path finds", "[snes]") {
  // Young's modulus and shear modulus of the thesis's Ogden material matched by springs alone, under its
  // large shear load on each node; on fewer cells than the thesis's.
  const cases::Scene scene = cases::make_scene(bodies::clamped_box({6, 6, 6}, bodies::shear(0.01)));
  const msm::CellStiffness soft = bodies::cell(23.3, 6.5, 22.7);
  mechanics::EquilibriumSettings coarse;
  coarse.smallest_load_step = 2e-3; // every halving of it costs as many factorisations again
  const auto limit = [](const auto& solve) {
    try {
      solve();
    } catch (const cases::SolveError& error) {
      CHECK(error.outcome() == cases::Outcome::limit_point);
      return error.load_reached();
    }
    return 1.0;
  };
  const double fast = limit([&] { msm::Model(scene, {soft}).solve(coarse); });
  const double general = limit([&] { msm::solve_by_snes(scene, {soft}, PETSC_COMM_WORLD, coarse); });
  CHECK(fast < 0.8);
  CHECK(std::abs(fast - general) <= 8e-3); // both end within twice the smallest step
}

TEST_CASE_METHOD(WithMpi, "SNES leads a bar around by its end as the fast path does", "[snes]") {
  cases::Case definition = bodies::clamped_box({2, 2, 12}, {});
  cases::Moved turned;
  turned.region = bodies::region("z+");
  turned.angle = 300;
  turned.centre = {1, 1, 12};
  definition.moved = {turned};
  const cases::Scene scene = cases::make_scene(definition);
  const cases::Solution fast = msm::Model(scene, {springs}).solve(tight());
  const cases::Solution general =
      msm::solve_by_snes(without_its_grid(scene), {springs}, PETSC_COMM_WORLD, tight());
  CHECK(largest_difference(fast, general) <= 1e-7); // mm, of displacements of millimetres
}
