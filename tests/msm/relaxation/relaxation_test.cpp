#include "msm/relaxation/relaxation.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "msm/model.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <functional>

using namespace springproof;

namespace {

using bodies::thesis_cell;
const std::vector<cases::Solver> relaxations = {cases::Solver::force_scaling, cases::Solver::fire,
                                                cases::Solver::lbfgs};

cases::Solution solve(cases::Case definition, cases::Solver solver, const msm::CellStiffness& stiffness,
                      const mechanics::EquilibriumSettings& settings = {}) {
  definition.msm.solver = solver;
  return msm::Model(cases::make_scene(definition), {stiffness}).solve(settings);
}

} // namespace

TEST_CASE("every explicit relaxation ends where Newton's method does") {
  const cases::Case pulled = bodies::clamped_box({3, 3, 3}, bodies::tensile(0.05));
  for (const msm::CellStiffness& stiffness : {thesis_cell, bodies::hybrid_cell}) {
    const cases::Solution newton = solve(pulled, cases::Solver::newton, stiffness);
    for (const cases::Solver solver : relaxations) {
      INFO(cases::name_of(solver));
      const cases::Solution relaxed = solve(pulled, solver, stiffness);
      CHECK(relaxed.residual <= 1e-9);
      // mm: 1e-9 of a load of 0.2 N over the lowest stiffness met here, above 1e-3 N/mm
      CHECK(largest_difference(relaxed, newton) < 2e-7);
      CHECK(relaxed.outcome == cases::Outcome::stable_equilibrium);
      CHECK(relaxed.relaxation_iterations > 0);
      CHECK(relaxed.newton_iterations == 0);
      CHECK(relaxed.load_reached == 1);
    }
  }
}

TEST_CASE("an explicit relaxation on a body whose top is moved ends where Newton's method does") {
  cases::Case pressed = bodies::clamped_box({3, 3, 3}, {});
  cases::Moved down;
  down.region = bodies::region("z+");
  down.displacement = {0, 0, -0.3};
  pressed.moved = {down};
  const cases::Solution newton = solve(pressed, cases::Solver::newton, thesis_cell);
  const cases::Solution relaxed = solve(pressed, cases::Solver::lbfgs, thesis_cell);
  CHECK(largest_difference(relaxed, newton) < 1e-6); // mm; 1e-9 of reactions of some 0.1 N over 1e-3 N/mm
  CHECK(relaxed.displacement.back().z() == -0.3);
}

TEST_CASE("an explicit relaxation that uses up its iterations says so, with the residual it has") {
  const cases::Case pulled = bodies::clamped_box({3, 3, 3}, bodies::tensile(0.05));
  mechanics::EquilibriumSettings settings;
  settings.max_relaxation_iterations = 5;
  for (const cases::Solver solver : relaxations) {
    INFO(cases::name_of(solver));
    try {
      solve(pulled, solver, thesis_cell, settings);
      FAIL("an equilibrium was reported");
    } catch (const cases::SolveError& error) {
      CHECK_THAT(error.what(), Catch::Contains("limit of 5 iterations"));
      CHECK(error.residual() > 1e-9);
      CHECK(error.outcome() == cases::Outcome::unknown);
      CHECK(error.so_far().relaxation_iterations == 5);
      CHECK(error.so_far().force_evaluations > 5);
      CHECK(error.so_far().unknowns == 3 * 48);
    }
  }
}

TEST_CASE("an explicit relaxation can be stopped") {
  mechanics::EquilibriumSettings settings;
  int asked = 0;
  settings.should_stop = [&] { return ++asked == 4; };
  CHECK_THROWS_AS(solve(bodies::clamped_box({3, 3, 3}, bodies::tensile(0.05)), cases::Solver::fire,
                        thesis_cell, settings),
                  cases::SolveError);
  CHECK(asked == 4);
}

TEST_CASE("force scaling of a given number of iterations takes as many, and is in equilibrium after enough") {
  cases::Case pressed = bodies::clamped_box({3, 3, 3}, {});
  cases::Moved down;
  down.region = bodies::region("z+");
  down.displacement = {0, 0, -0.3};
  pressed.moved = {down};
  const cases::Solution newton = solve(pressed, cases::Solver::newton, thesis_cell);
  CHECK_FALSE(newton.from_equilibrium);
  pressed.msm.relaxation = cases::RelaxationCounts{5, 3, 20};
  const cases::Solution few = solve(pressed, cases::Solver::force_scaling, thesis_cell);
  CHECK(few.status == cases::Status::converged);
  CHECK(few.relaxation_iterations == 35);
  CHECK(few.residual > 1e-9);
  CHECK(few.outcome == cases::Outcome::unknown);
  CHECK_FALSE(few.is_equilibrium());
  CHECK(few.displacement.back().z() == -0.3);
  pressed.msm.relaxation = cases::RelaxationCounts{5, 30, 3000};
  const cases::Solution many = solve(pressed, cases::Solver::force_scaling, thesis_cell);
  CHECK(many.relaxation_iterations == 3150);
  CHECK(many.is_equilibrium());
  CHECK(largest_difference(many, newton) < 1e-6); // mm; 1e-9 of reactions of some 0.1 N over 1e-3 N/mm
  CHECK(largest_difference(few, newton) > 1e-4);
}

TEST_CASE("force scaling moves points along their forces by one length of step at all iterations") {
  cases::Case pulled = bodies::clamped_box({2, 2, 2}, bodies::tensile(1e-6)); // small: forces are linear
  const auto after = [&](int n) {
    pulled.msm.relaxation = cases::RelaxationCounts{1, 0, n};
    return solve(pulled, cases::Solver::force_scaling, thesis_cell).displacement;
  };
  const auto once = after(1), twice = after(2);
  // The springs have no forces yet: the top moves by alpha times its load, and nothing else moves.
  const double alpha_load = once.back().z();
  CHECK(alpha_load > 0);
  for (std::size_t n = 0; n < 18; ++n) CHECK(once[n].norm() == 0); // below the top
  CHECK(twice.back().z() > alpha_load);
  CHECK(twice.back().z() < 2 * alpha_load);
  CHECK(twice[9 + 4].z() > 0); // the layer below is pulled now
}
