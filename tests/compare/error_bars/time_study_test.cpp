#include "compare/error_bars/time_study.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"
#include "compare/measure/measure.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

namespace {

/// A bar of 2 x 1 x 1 cells that is pulled smoothly for as long as its end moves one way.
cases::Case pulled(const std::string& scheme, double step) {
  return cases::read_case_text(R"(
schema = 1
name = "pulled"
[body]
shape = "box"
size = [20, 10, 10]
cells = [2, 1, 1]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
stiffness_damping = 0.001
[[fixed]]
region = "x-"
[[load]]
kind = "total_force"
region = "x+"
value = [0.1, 0, 0]
history = { sine = 20 }
[fem]
accuracy = "none"
[msm]
design = "hybrid"
[[measure]]
name = "end"
kind = "displacement"
node = "x+ y+ z+"
component = "x"
[dynamics]
scheme = ")" + scheme +
                                   "\"\nend = 0.016\nstep = " + std::to_string(step) + "\n",
                               "pulled.toml");
}

compare::Answers solved(const cases::Scene& scene) {
  return compare::solve(scene, {}, compare::solve_fem);
}

} // namespace

TEST_CASE("the error of time integration is told by half the step, for both models", "[verification]") {
  for (const std::string scheme : {"implicit_euler", "newmark", "bdf2"}) {
    INFO(scheme);
    const cases::Scene scene = cases::make_scene(pulled(scheme, 0.0004));
    const auto study = compare::study_time(scene, solved(scene), {}, compare::solve_fem);
    REQUIRE(study.size() == 1);
    REQUIRE((study[0].fem && study[0].msm));
    const cases::Scene fine = cases::make_scene(pulled(scheme, 0.0004 / 16));
    const compare::Answers exact = solved(fine);
    const cases::Measure& measure = scene.definition.measures.front();
    for (const auto& [halved, answer] :
         {std::pair{&*study[0].fem, &exact.fem}, std::pair{&*study[0].msm, &exact.msm}}) {
      const double error = halved->value - *compare::value_of(measure, fine, answer->solution);
      const double told = halved->value - halved->extrapolated;
      CHECK(told == Approx(error).epsilon(0.15)); // the reference errs by a sixteenth of it at order 1
    }
  }
}

TEST_CASE("a static case has no error of time integration") {
  cases::Case definition = pulled("newmark", 0.0004);
  definition.dynamics.reset();
  const cases::Scene scene = cases::make_scene(definition);
  CHECK_THROWS_AS(compare::study_time(scene, {}, {}, compare::solve_fem), cases::InputError);
}
