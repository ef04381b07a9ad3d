#include "compare/study/error_budget.hpp"

#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

/// A clamped beam under a small traction at its end, which moduli() follow at nu = 1/4.
cases::Case beam(const std::string& more, const std::string& springs = "design = \"moduli\"") {
  return cases::read_case_text("schema = 1\nname = \"beam\"\ndescription = \"d\"\n"
                               "[body]\nshape = \"box\"\nsize = [40, 10, 10]\ncells = [8, 2, 2]\n"
                               "[material]\nmodel = \"linear_elastic\"\nyoungs_modulus = 0.3\n"
                               "poissons_ratio = 0.25\ndensity = 1000\n[msm]\n" +
                                   springs +
                                   "\n[[fixed]]\nregion = \"x-\"\n"
                                   "[[measure]]\nname = \"tip\"\nkind = \"displacement\"\n"
                                   "node = \"near 40 5 5\"\ncomponent = \"z\"\n" +
                                   more,
                               "beam.toml");
}

const char* const small_load = "[[load]]\nregion = \"x+\"\nkind = \"traction\"\nvalue = [0, 0, 1e-6]\n"
                               "[[measure]]\nname = \"everywhere\"\nkind = \"displacement_field_l2\"\n"
                               "[[measure]]\nname = \"largest\"\nkind = \"displacement_field_max\"\n";

compare::ErrorBudgets budgets_of(const cases::Case& definition) {
  compare::Request request;
  request.meshes = 3;
  return compare::study_errors(compare::compare_case(definition, request), request);
}

} // namespace

TEST_CASE("springs with the material's moduli err by their mesh alone", "[verification]") {
  const compare::ErrorBudgets budgets = budgets_of(beam(small_load));
  CHECK(budgets.lattices == std::vector<int>{0, 1, 2});
  CHECK(budgets.note.empty());
  REQUIRE(budgets.springs.size() == 3);
  for (const compare::ErrorBudget& budget : {budgets.springs[0], budgets.springs[1]}) {
    INFO(budget.measure);
    CHECK(std::abs(*budget.law.percent) < 1); // what three lattices leave, of a mesh's part above 10
    CHECK(std::abs(*budget.mesh.percent) > 10);
    CHECK(*budget.step.percent == 0);
    CHECK(*budget.iterations.percent == 0);
    CHECK(*budget.sum() == Approx(*budget.whole).epsilon(1e-9));
    CHECK_FALSE(budget.cancels());
  }
  CHECK(budgets.springs[2].reason.find("two places") != std::string::npos);
  const compare::ErrorBudget& fem = budgets.fem.at(0);
  CHECK(*fem.law.percent == 0);
  CHECK(*fem.sum() == Approx(*fem.whole).epsilon(1e-9));
}

TEST_CASE("parts of a motion's error add up to it within a tenth, and the finite elements have no law",
          "[verification]") {
  const compare::ErrorBudgets budgets =
      budgets_of(beam("[[load]]\nregion = \"x+\"\nkind = \"traction\"\nvalue = [0, 0, 1e-5]\n"
                      "[dynamics]\nstep = 0.001\nend = 0.02\nscheme = \"implicit_euler\"\n",
                      "design = \"moduli\""));
  const compare::ErrorBudget &springs = budgets.springs.at(0), &fem = budgets.fem.at(0);
  for (const compare::ErrorBudget* budget : {&springs, &fem}) {
    CHECK(std::abs(*budget->step.percent) > 1);
    CHECK(std::abs(*budget->sum() - *budget->whole) <= 0.1 * std::abs(*budget->whole));
    CHECK(*budget->iterations.percent == 0);
  }
  CHECK(std::abs(*springs.law.percent) < 1);
  CHECK(*fem.law.percent == 0);
}

TEST_CASE("springs with other moduli than the material's err by their law", "[verification]") {
  const compare::ErrorBudget tip = budgets_of(beam(small_load, "design = \"uniform\"")).springs.at(0);
  CHECK(std::abs(*tip.law.percent) > 5);
}

TEST_CASE("what iterations leave is the distance from the equilibrium of the same springs",
          "[verification]") {
  const cases::Case cut_off =
      beam(small_load, "design = \"moduli\"\nsolver = \"force_scaling\"\nrelaxation_steps = 2\n"
                       "relaxation_iterations = 20");
  const compare::ErrorBudget found = budgets_of(cut_off).springs.at(0);
  const compare::ErrorBudget solved = budgets_of(beam(small_load)).springs.at(0);
  CHECK(*found.iterations.percent < -10); // the load has not arrived at the beam's middle yet
  CHECK(*found.mesh.percent == Approx(*solved.mesh.percent).margin(1e-4));
  CHECK(*found.law.percent == Approx(*solved.law.percent).margin(1e-4));
  CHECK(*found.whole - *solved.whole == Approx(*found.iterations.percent).margin(1e-4));
}

TEST_CASE("elements that a method steps err by their law and iterations too, and the parts add up",
          "[verification]") {
  const std::string load = "[[load]]\nregion = \"x+\"\nkind = \"traction\"\nvalue = [0, 0, 1e-4]\n";
  const std::string method =
      "[fem]\nreal_time = { method = \"corotational\", iterations = 5, damping = 5 }\n";
  const compare::ErrorBudget fem = budgets_of(beam(load + method)).fem.at(0);
  CHECK(*fem.law.percent != 0); // not log_strain's
  CHECK(std::abs(*fem.law.percent) < 1);
  CHECK(*fem.step.percent == 0);
  CHECK(std::abs(*fem.iterations.percent) < 0.5); // at rest few are enough
  CHECK(*fem.sum() == Approx(*fem.whole).epsilon(1e-9));
  const std::string method_in_motion = "[fem]\nreal_time = { method = \"corotational\", iterations = 3 }\n";
  const std::string motion = "[dynamics]\nstep = 0.001\nend = 0.02\nscheme = \"implicit_euler\"\n";
  const compare::ErrorBudget moving = budgets_of(beam(load + method_in_motion + motion)).fem.at(0);
  CHECK(std::abs(*moving.step.percent) > 1);
  CHECK(std::abs(*moving.iterations.percent) > 0.01);
  CHECK(*moving.sum() == Approx(*moving.whole).epsilon(1e-9));
}

TEST_CASE("springs of a file have no finer lattice, and their law and mesh are not told apart",
          "[verification]") {
  const compare::ErrorBudgets budgets =
      budgets_of(beam(small_load, "design = \"given\"\nstiffness = [100, 40, 60]"));
  CHECK(budgets.lattices == std::vector<int>{0});
  const compare::ErrorBudget& tip = budgets.springs.at(0);
  CHECK_FALSE(tip.law.percent);
  CHECK_FALSE(tip.sum());
  CHECK(tip.whole);
  CHECK(tip.mesh.reason.find("have no limit") != std::string::npos);
}

TEST_CASE("a finer lattice is a grid with each cell's material, and has the springs of a body made so",
          "[verification]") {
  const std::string layer =
      "[[region_material]]\nmodel = \"linear_elastic\"\nbox = [[20, 0, 0], [40, 10, 5]]\n"
      "density = 1000\nyoungs_modulus = 0.9\npoissons_ratio = 0.25\n";
  const cases::Case coarse = beam(small_load + layer);
  cases::Case made = coarse;
  std::get<cases::Box>(made.body).cells = {16, 4, 4};
  const cases::Scene fine = compare::finer_lattice(cases::make_scene(coarse)),
                     other = cases::make_scene(made);
  REQUIRE(fine.mesh.grid);
  CHECK(fine.mesh.grid->cells == std::array<int, 3>{16, 4, 4});
  CHECK(fine.material_of_cell == other.material_of_cell);
  std::optional<msm::DesignResult> unused;
  const cases::Solution ours = compare::solve_springs(fine, 1, unused).solution,
                        theirs = compare::solve_springs(other, 1, unused).solution;
  const auto tip = [](const cases::Scene& scene, const cases::Solution& solution) {
    return compare::evaluate(scene.definition.measures.at(0), scene, solution);
  };
  CHECK(tip(fine, ours) == Approx(tip(other, theirs)).epsilon(1e-8));
}
