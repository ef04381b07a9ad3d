#include "compare/hard/stress.hpp"

#include "cases/case/read_case.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/solve/solve.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace springproof;

using compare::misses;

namespace {

const cases::ExpectedOutcome limit_point{
    "msm", cases::Side::msm, {}, cases::Outcome::limit_point, std::array<double, 2>{0.7, 0.8}, 0};

cases::Stress allowing(double seconds, int iterations) {
  cases::Stress limits;
  limits.max_seconds = seconds;
  limits.max_iterations = iterations;
  return limits;
}

compare::Answer as_expected() {
  compare::Answer side;
  side.solution.outcome = cases::Outcome::limit_point;
  side.solution.load_reached = 0.75;
  side.solution.newton_iterations = 10;
  side.setup_seconds = 1;
  side.solve_seconds = 2;
  return side;
}

std::vector<std::string> found(const compare::Answer& side) {
  return misses(allowing(3, 10), limit_point, side);
}

} // namespace

TEST_CASE("a hard case's side that does as expected, to the last second and iteration, misses nothing") {
  CHECK(found(as_expected()).empty());
}

TEST_CASE("each thing that differs from what a hard case expects is told") {
  compare::Answer side = as_expected();
  side.solution.outcome = cases::Outcome::stable_equilibrium;
  CHECK(found(side) == std::vector<std::string>{"outcome stable equilibrium, expected limit point"});
  side = as_expected();
  side.solution.load_reached = 0.9;
  CHECK(found(side) == std::vector<std::string>{"load reached 0.9 is outside [0.7, 0.8]"});
  side = as_expected();
  side.solution.inverted_cells = 2;
  CHECK(found(side) == std::vector<std::string>{"2 inverted cells, expected 0"});
  side = as_expected();
  side.solve_seconds = 2.1;
  CHECK(found(side) == std::vector<std::string>{"3.1 s, above the limit of 3.0 s"});
  side = as_expected();
  side.solution.newton_iterations = 11;
  CHECK(found(side) == std::vector<std::string>{"11 iterations, above the limit of 10"});
}

TEST_CASE("what is not a number is never as expected") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  compare::Answer side = as_expected();
  side.solution.load_reached = nan;
  CHECK(found(side).size() == 2); // outside, and not finite
  side = as_expected();
  side.solution.residual = nan;
  CHECK(found(side) == std::vector<std::string>{"a result is not finite"});
  side = as_expected();
  side.solution.lowest_eigenvalue = nan;
  CHECK(found(side).size() == 1);
  side = as_expected();
  side.solution.displacement = {Eigen::Vector3d(0, nan, 0)};
  CHECK(found(side).size() == 1);
  side = as_expected();
  side.solve_seconds = nan;
  CHECK(found(side).size() == 1);
}

TEST_CASE("a model that cannot be made is refused, with the reason") {
  const cases::Solution solution = compare::failed_solution(cases::InputError("no such body"));
  CHECK(solution.outcome == cases::Outcome::refused);
  CHECK(solution.status == cases::Status::failed);
  CHECK(solution.message == "no such body");
}

TEST_CASE("each model of a hard case is a job of its own, the hybrid one of springs of that design") {
  const std::string file = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/hard/torsion_90.toml";
  const cases::Case hard_case = cases::read_hard_case(file);
  const std::vector<compare::Question> jobs = compare::jobs_for(hard_case, 2);
  REQUIRE(jobs.size() == 3);
  const char* names[] = {"torsion_90 msm", "torsion_90 hybrid", "torsion_90 fem"};
  for (std::size_t j = 0; j < 3; ++j) {
    CHECK(jobs[j].scene.definition.name == names[j]);
    CHECK(jobs[j].request.only == (j < 2 ? cases::Side::msm : cases::Side::fem));
    CHECK(jobs[j].request.n_threads == 2);
    CHECK(jobs[j].scene.definition.msm.design ==
          (j == 1 ? cases::Design::hybrid : cases::Design::linear_method));
  }
  const compare::StressResult judged = compare::judge_stress(hard_case, 2, {3, compare::Answer{}});
  REQUIRE(judged.rows.size() == 3);
  CHECK_FALSE(judged.met());
  CHECK(judged.rows[1].expected.model == "hybrid");
}

TEST_CASE("the hybrid's time is compared with the springs' where both found an equilibrium") {
  compare::StressResult result;
  compare::StressRow springs{limit_point, as_expected(), {}}, hybrid = springs;
  hybrid.expected.model = "hybrid";
  hybrid.answer.solve_seconds = 3;
  result.rows = {springs, hybrid};
  CHECK_FALSE(result.hybrid_over_springs().has_value());
  for (compare::StressRow& row : result.rows) row.answer.solution.status = cases::Status::converged;
  CHECK(result.hybrid_over_springs() == 1.5);
  CHECK(result.met());
  result.rows[1].misses = {"something"};
  CHECK_FALSE(result.met());
}
