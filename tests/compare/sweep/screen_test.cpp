// What a sweep prints: its answers, on one screen.

#include "compare/provenance/print.hpp"
#include "compare/sweep/analysis.hpp"
#include "compare/sweep/write_sweep.hpp"
#include "tests/support/screen.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;
using Catch::Contains;

namespace {

constexpr std::size_t one_screen = 45; ///< lines

Variant lattice(int cells) {
  return {Program::springs, cases::Design::nonlinear_method, {}, {}, {cells, cells, cells}, 1e-9};
}

Variant bricks(int cells) {
  return {Program::finite_elements, {},  cases::Formulation::saint_venant_kirchhoff, cases::Element::q1_bbar,
          {cells, cells, cells},    1e-9};
}

SweepRow with_answer(const Variant& variant, double seconds, double error) {
  SweepRow row{variant, {}, error, {-2 * error}};
  row.run.first.status = cases::Status::converged;
  row.run.first_seconds = row.run.again_seconds = {seconds};
  return row;
}

SweepRow with_failure(const Variant& variant) {
  SweepRow row{variant, {}, std::nullopt, {}};
  row.run.first.status = cases::Status::failed;
  row.run.first.message = "equilibrium lost, as " + std::string(90, '.') + " they " + std::string(90, '.');
  return row;
}

/// A front of many points of both families, many failures, and everything as wide as it comes.
Sweep wide_sweep() {
  Sweep sweep;
  sweep.definition.name = "a-case";
  sweep.definition.description = std::string(80, 'x') + " " + std::string(80, 'y');
  sweep.plan.levels = {{1, 1, 1}, {128, 128, 128}};
  sweep.plan.reference = {bricks(32), bricks(64), bricks(128)};
  for (int i = 0; i < 3; ++i) sweep.rows.push_back(with_answer(bricks(32 << i), 10. + i, 0.1));
  for (int i = 0; i < 20; ++i) sweep.rows.push_back(with_answer(lattice(100 + i), 1e-4 * (i + 1), 40. - i));
  for (int i = 0; i < 20; ++i) sweep.rows.push_back(with_answer(bricks(100 + i), 2e-3 * (i + 1), 20. - i));
  for (int i = 0; i < 9; ++i) sweep.rows.push_back(with_failure(lattice(10 + i)));
  for (const SweepRow& row : sweep.rows) sweep.plan.variants.push_back(row.variant);
  sweep.plan.left_out = {{"a model", "too large"},
                         {"another", "large " + std::string(70, 'z') + " " + std::string(200, 'z')}};
  sweep.reference.emplace();
  sweep.reference->field = {"displacement", "mm", 1, 0.1, ""};
  sweep.reference->measures = {{"u", "mm", 1, 0.2, ""}};
  sweep.settings = {"material.poissons_ratio=0.3"};
  return sweep;
}

std::string screen_of(const Sweep& sweep, const std::string& folder = "") {
  std::ostringstream out;
  write_sweep_screen(out, sweep, folder);
  return out.str();
}

} // namespace

TEST_CASE("a sweep's text is one screen, its answers first, and shouts nowhere") {
  const std::string text = screen_of(wide_sweep());
  INFO(text);
  CHECK(lines_of_text(text).size() <= one_screen);
  CHECK(width_of_text(text) <= screen_width);
  CHECK(text.find("\nFastest") < text.find("Speed against error"));
  CHECK(text.find("Speed against error") < text.find("equilibrium lost"));
  CHECK_FALSE(has_shouting(text, {"DIR"}));
  CHECK_THAT(text, Contains("with material.poissons_ratio=0.3"));
}

TEST_CASE("the faster family is marked, with its factor, and one that does not get there is told") {
  Sweep sweep = wide_sweep();
  sweep.rows = {with_answer(bricks(32), 1, 0.1), with_answer(bricks(64), 2, 0.1),
                with_answer(bricks(128), 3, 0.1), with_answer(lattice(8), 0.25, 4)};
  const std::vector<std::string> lines = lines_of_text(screen_of(sweep));
  const auto row = [&](const std::string& label) {
    const auto found = std::find_if(lines.begin(), lines.end(), [&](const std::string& line) {
      return line.rfind("  " + label, 0) == 0;
    });
    REQUIRE(found != lines.end());
    return *found;
  };
  CHECK_THAT(row("5 %"), Contains(">  250 ms nonlinear_method 8x8x8") && Contains("(4 x)") &&
                             Contains(" 1 s saint_venant_kirchhoff... 32x32x32"));
  CHECK_THAT(row("1 %"), Contains("none") && Contains(">     1 s saint_venant"));
  CHECK_THAT(row("500 Hz"), Contains("none")); // neither answers in 2 ms
  sweep.rows.push_back(with_answer(lattice(4), 0.0081, 6));
  const std::string text = screen_of(sweep);
  CHECK_THAT(text, Contains(" 6 % at 8.1 ms: nonlinear_method 4x4x4"));
}

TEST_CASE("an error below the reference's uncertainty is not judged on the screen either") {
  Sweep sweep = wide_sweep();
  sweep.reference->field.uncertainty_percent = 7;
  CHECK_THAT(screen_of(sweep), Contains("not to be told: the reference is itself uncertain by 7 %"));
}

TEST_CASE("models that failed are rows with their reasons, as many as fit, and the others are counted") {
  const std::string text = screen_of(wide_sweep());
  CHECK_THAT(text, Contains("springs nonlinear_method 10x10x10 to 1e-09 failed: equilibrium lost, as"));
  CHECK_THAT(text, Contains("and 7 more failed") && Contains("left out: 2, such as another"));
}

TEST_CASE("a sweep has an answer with its reference and a model beside it, whatever else failed") {
  Sweep sweep = wide_sweep();
  CHECK(has_answer(sweep));
  sweep.rows = {with_answer(bricks(32), 1, 1), with_answer(bricks(64), 1, 1), with_answer(bricks(128), 1, 1)};
  CHECK(has_answer(sweep)); // no more were asked for
  sweep.rows.push_back(with_failure(lattice(1)));
  CHECK_FALSE(has_answer(sweep));
  sweep.rows.push_back(with_answer(lattice(2), 1, 1));
  CHECK(has_answer(sweep));
  sweep.reference.reset();
  sweep.reason_without_reference = "its finest mesh was not solved";
  CHECK_FALSE(has_answer(sweep));
  CHECK_THAT(screen_of(sweep), Contains("nothing can be concluded without a reference: its finest mesh"));
}

TEST_CASE("a front is thinned evenly, and keeps its ends") {
  const Sweep sweep = wide_sweep();
  const auto points = points_of(sweep, Error::field, Clock::re_solve);
  const auto front = pareto_front(points);
  REQUIRE(front.size() > 7);
  const auto thinned = thinned_front(points, 7);
  REQUIRE(thinned.size() == 7);
  CHECK(thinned.front().name == points[front.front()].name);
  CHECK(thinned.back().name == points[front.back()].name);
  CHECK(thinned_front(points, 1000).size() == front.size());
  CHECK(thinned_front({}, 7).empty());
}

TEST_CASE("a sweep in time is one screen too, and has an answer with any motion") {
  Sweep sweep;
  sweep.definition.name = "a-case";
  sweep.definition.description = "moves";
  sweep.definition.dynamics.emplace();
  sweep.reference.emplace().field = {
      "", "", 0, 0.1, "log_strain q1_bbar, 32x32x32 cells, generalized_alpha with steps of 2.5 ms"};
  for (int i = 0; i < 30; ++i) {
    SweepRow row = i < 25 ? with_answer(lattice(10), 0.01 * (i + 1), 40. - i) : with_failure(lattice(10));
    row.variant.step = 0.001;
    sweep.rows.push_back(row);
  }
  const std::string text = screen_of(sweep, "results");
  INFO(text);
  CHECK(lines_of_text(text).size() <= one_screen);
  CHECK(width_of_text(text) <= screen_width);
  CHECK_THAT(text, Contains("at 60 Hz") && Contains("and 3 more failed") && Contains("results"));
  CHECK(has_answer(sweep));
  for (SweepRow& row : sweep.rows) row = with_failure(row.variant);
  CHECK_FALSE(has_answer(sweep));
}
