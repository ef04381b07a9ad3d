#include "compare/sweep/write_motion_sweep.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using compare::MotionRow;
using compare::MotionSweep;

namespace motion_sweeps {

namespace {

cases::Case block(const std::string& node = "x+ y+ z+") {
  return cases::read_case_text(R"(
schema = 1
name = "block"
[body]
shape = "box"
size = [10, 10, 20]
cells = [2, 2, 4]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
mass_damping = 20
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [9.81, 0, 0]
[dynamics]
scheme = "newmark"
step = 0.005
end = 0.06
[[measure]]
name = "tip"
kind = "displacement"
node = ")" + node + R"("
component = "x"
[fem]
formulation = "log_strain"
element = "q1_bbar"
[msm]
design = "hybrid"
)",
                           "block.toml");
}

cases::Trajectory motion(const std::vector<double>& times, double factor) {
  cases::Trajectory result;
  result.nodes = {3};
  for (const double time : times) {
    result.time.push_back(time);
    result.displacement.emplace_back(factor * time, 0, 0);
  }
  return result;
}

MotionRow row(double step, double seconds, std::optional<double> error) {
  return {"springs hybrid",
          compare::Family::springs,
          {2, 2, 2},
          step,
          cases::Status::converged,
          "",
          81,
          seconds,
          error};
}

} // namespace

TEST_CASE("the difference of two motions is of the times that both have") {
  const auto fine = motion({0, 0.5, 1, 1.5, 2}, 1), coarse = motion({0, 1, 2}, 1.1);
  CHECK(compare::motion_error_percent(fine, coarse).value() == Approx(10));
  CHECK(compare::motion_error_percent(fine, fine).value() == 0);
  CHECK_FALSE(compare::motion_error_percent(motion({0, 1}, 0), coarse)); // nothing moves
  CHECK(std::isnan(compare::motion_error_percent(fine, motion({0, 1}, std::nan(""))).value()));
}

TEST_CASE("the most accurate motion at a rate keeps up with it") {
  MotionSweep sweep;
  sweep.uncertainty_percent = 1;
  sweep.rows = {row(0.02, 0.1, 2), row(0.01, 0.5, 5), row(0.01, 0.9, 3), row(0.005, 1.1, 1.5),
                row(0.01, 0.2, std::nullopt)};
  CHECK(compare::interactive_sentence(sweep, 60).find("error 3 %, 0.9 s") != std::string::npos);
  CHECK(compare::interactive_sentence(sweep, 30).find("error 2 %") != std::string::npos);
  CHECK(compare::interactive_sentence(sweep, 500) == "at 500 Hz: none of these motions keeps up");
}

TEST_CASE("a sweep in time has every method, mesh and step, and errors that fall with both") {
  int n_calls = 0;
  const MotionSweep sweep =
      compare::sweep_motion(block(), compare::Extent::quick, [&](const MotionSweep&) { ++n_calls; });
  REQUIRE(sweep.rows.size() == 2 * 3 * 3);
  CHECK(n_calls == 18);
  CHECK(sweep.uncertainty_percent > 0);
  CHECK(sweep.uncertainty_percent < 20); // coarse as the meshes are
  for (const MotionRow& motion : sweep.rows) {
    INFO(motion.method << " " << compare::cells_name(motion.cells) << " " << motion.step << " "
                       << motion.message);
    REQUIRE(motion.error_percent);
    CHECK(std::isfinite(*motion.error_percent));
    CHECK(motion.seconds_per_second > 0);
  }
  // finite elements: coarsest with the longest step, finest with the shortest
  CHECK(*sweep.rows[17].error_percent < 0.5 * *sweep.rows[1].error_percent);
  std::ostringstream text, csv;
  compare::write_motion_sweep_text(text, sweep);
  CHECK(text.str().find("at 60 Hz: ") != std::string::npos);
  compare::write_motion_sweep_csv(csv, sweep);
  const std::string lines = csv.str();
  CHECK(std::count(lines.begin(), lines.end(), '\n') == 19);
  const auto document = compare::motion_sweep_to_json(sweep);
  CHECK(document["motions"].size() == 18);
  CHECK(document["motions"][0]["error_percent"].is_number());
}

TEST_CASE("a sweep in time says what it cannot sweep") {
  const auto none = [](const MotionSweep&) {};
  CHECK_THROWS_AS(compare::sweep_motion(block("near 2.5 5 20"), compare::Extent::quick, none),
                  cases::InputError);
  cases::Case odd = block();
  odd.dynamics->end = 0.065;
  CHECK_THROWS_AS(compare::sweep_motion(odd, compare::Extent::quick, none), cases::InputError);
}

} // namespace motion_sweeps
