#include "compare/study/verdict.hpp"

#include "compare/table/table.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace springproof;

using Catch::Contains;

namespace {

/// Both models solved: one measure, whose limit is 100 +- 1 mm.
compare::Comparison solved(double fem, double msm) {
  compare::Comparison comparison;
  comparison.answers.fem.solution.status = comparison.answers.msm.solution.status = cases::Status::converged;
  comparison.answers.fem.setup_seconds = 0.5;
  comparison.answers.fem.solve_seconds = 1.5;
  comparison.answers.msm.solve_seconds = 0.1;
  compare::MeasuredValue measured{"u", "mm", fem, msm, msm - 100};
  measured.fem_limit = compare::Limit{100, 1, ""};
  measured.error_uncertainty_percent = 1;
  measured.fem_error_percent = fem - 100;
  comparison.measures = {measured};
  return comparison;
}

compare::Answer moved(double milliseconds_a_step) {
  compare::Answer answer;
  answer.solution.status = cases::Status::converged;
  answer.solution.trajectory.emplace();
  answer.solution.trajectory->time = {0, 0.1, 0.2};
  answer.setup_seconds = 10; // is of no step
  answer.solve_seconds = 2e-3 * milliseconds_a_step;
  return answer;
}

} // namespace

TEST_CASE("the verdict holds the springs' error against their mesh's as far as both are known") {
  const std::string springs = compare::verdict_of(solved(97, 80));
  CHECK_THAT(springs, Contains("The springs are up to 20.00 +- 1 % (u) from the truth") &&
                          Contains("themselves err by up to 3.00 +- 1 % on this mesh") &&
                          Contains("The springs err more than their mesh does."));
  CHECK_THAT(compare::verdict_of(solved(80, 97)), Contains("The mesh errs more than the springs do"));
  CHECK_THAT(compare::verdict_of(solved(97, 98.5)),
             Contains("do not tell the springs' error from their mesh's"));
  compare::Comparison unknown = solved(97, 80);
  unknown.measures[0].fem_limit.reset();
  unknown.measures[0].fem_error_percent.reset();
  unknown.measures[0].error_uncertainty_percent.reset();
  CHECK_THAT(compare::verdict_of(unknown),
             Contains("from the finite elements on the same mesh") && !Contains("mesh does"));
}

TEST_CASE("times of equilibria are compared with their setup, and a step in time is held against a screen") {
  compare::Comparison comparison = solved(97, 80);
  CHECK(compare::time_of(comparison) ==
        "Time: the springs 0.1 s; the finite elements 2 s; the springs are 20 times as fast.");
  comparison.answers.msm.solve_seconds = 3;
  CHECK_THAT(compare::time_of(comparison), Contains("the finite elements are 1.5 times as fast."));
  comparison.answers.msm_source = "another.vtu"; // whose time nobody knows
  CHECK(compare::time_of(comparison) == "Time: the finite elements 2 s.");
  comparison.answers = {};
  CHECK(compare::time_of(comparison).empty());
  comparison.answers.fem = moved(31);
  comparison.answers.msm = moved(8.1);
  CHECK(compare::time_of(comparison) ==
        "Time: the springs 8.1 ms a step: keeps 60 Hz; the finite elements 31 ms a "
        "step: does not keep 60 Hz.");
}

TEST_CASE("a run's last lines are its verdict and its commands, which are never broken") {
  std::ostringstream out;
  const std::string command = "springproof run " + std::string(120, 'p') + ".toml --designs all";
  compare::write_verdict_text(out, solved(97, 80), {{"springproof run a.toml", "short"}, {command, "long"}});
  CHECK_THAT(out.str(), Catch::StartsWith("Verdict: The springs are up to ") &&
                            Catch::EndsWith("What to type next:\n"
                                            "  springproof run a.toml   # short\n"
                                            "  # long\n  " +
                                            command + "\n"));
}
