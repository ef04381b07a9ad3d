#include "compare/hard/stress.hpp"

#include "compare/hard/stress_springs.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace springproof;

using compare::misses;

namespace {

const cases::ExpectedOutcome limit_point{
    cases::Side::msm, cases::Outcome::limit_point, std::array<double, 2>{0.7, 0.8}, 0, {}};

cases::HardCase allowing(double seconds, int iterations) {
  cases::HardCase hard_case;
  hard_case.max_seconds = seconds;
  hard_case.max_iterations = iterations;
  return hard_case;
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
  const compare::Answer side =
      compare::or_refused([]() -> compare::Answer { throw cases::InputError("no such body"); });
  CHECK(side.solution.outcome == cases::Outcome::refused);
  CHECK(side.solution.status == cases::Status::failed);
  CHECK(side.solution.message == "no such body");
}

TEST_CASE("the hybrid's time is compared with the springs' where both found an equilibrium") {
  compare::StressResult result;
  compare::StressRow springs{limit_point, as_expected(), {}}, hybrid = springs;
  hybrid.expected.side = cases::Side::hybrid;
  hybrid.answer.solve_seconds = 3;
  result.rows = {springs, hybrid};
  CHECK_FALSE(result.hybrid_over_springs().has_value());
  for (compare::StressRow& row : result.rows) row.answer.solution.status = cases::Status::converged;
  CHECK(result.hybrid_over_springs() == 1.5);
  CHECK(result.met());
  result.rows[1].misses = {"something"};
  CHECK_FALSE(result.met());
}
