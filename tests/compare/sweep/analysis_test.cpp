#include "compare/sweep/write_sweep.hpp"

#include "compare/provenance/print.hpp"
#include "tests/support/screen.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using namespace compare;
using Errors = std::vector<std::optional<double>>;
using Catch::Contains;

namespace {

Point springs_at(double seconds, double error) {
  return {"springs", Family::springs, seconds, error};
}
Point elements_at(double seconds, double error) {
  return {"elements", Family::finite_elements, seconds, error};
}

const std::vector<Point> three_points{{"A", Family::springs, 0.0005, 8},
                                      {"B", Family::finite_elements, 0.005, 9},
                                      {"C", Family::finite_elements, 0.05, 0.5}};

using Places = std::vector<std::pair<double, double>>; ///< seconds, error

Places front_of(const std::vector<Point>& points) {
  Places places;
  for (const Point& point : pareto_front(points)) places.emplace_back(point.seconds, point.error_percent);
  return places;
}

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

TEST_CASE("the Pareto front keeps what nothing beats, in the order of time") {
  CHECK(front_of({elements_at(4, 1), springs_at(1, 9), springs_at(2, 10), elements_at(3, 2)}) ==
        Places{{1, 9}, {3, 2}, {4, 1}});
}

TEST_CASE("of points that tie in time or error the Pareto front keeps the better, of equal ones the first") {
  CHECK(front_of({springs_at(1, 5), springs_at(1, 3)}) == Places{{1, 3}});
  CHECK(front_of({springs_at(1, 3), springs_at(2, 3)}) == Places{{1, 3}});
  CHECK(pareto_front({springs_at(1, 3), elements_at(1, 3)}).at(0).name == "springs");
}

TEST_CASE("the Pareto front of no point is empty and of one point that point") {
  CHECK(pareto_front({}).empty());
  CHECK(front_of({springs_at(1, 0)}) == Places{{1, 0}});
}

TEST_CASE("the fastest within an error may be asked of one family") {
  const std::vector<Point> points{springs_at(1, 20), springs_at(2, 8), elements_at(3, 8), elements_at(9, 1)};
  CHECK(fastest_within(points, 10) == std::optional<std::size_t>(1));
  CHECK(fastest_within(points, 8) == std::optional<std::size_t>(1)); // the bound itself is within
  CHECK(fastest_within(points, 10, Family::finite_elements) == std::optional<std::size_t>(2));
  CHECK_FALSE(fastest_within(points, 1, Family::springs));
  CHECK_FALSE(fastest_within({}, 100));
}

TEST_CASE("of equally fast points the more accurate wins, of equally accurate ones the faster") {
  CHECK(fastest_within({springs_at(1, 5), elements_at(1, 4)}, 10) == std::optional<std::size_t>(1));
  CHECK(most_accurate_within({springs_at(2, 4), elements_at(1, 4)}, 10) == std::optional<std::size_t>(1));
}

TEST_CASE("the most accurate within a time takes at most that time") {
  const std::vector<Point> points{springs_at(1, 20), springs_at(2, 8), elements_at(9, 1)};
  CHECK(most_accurate_within(points, 2) == std::optional<std::size_t>(1));
  CHECK(most_accurate_within(points, 9) == std::optional<std::size_t>(2));
  CHECK_FALSE(most_accurate_within(points, 0.5));
}

TEST_CASE("the floor is reached where all finer levels are near the last") {
  CHECK(first_level_at_floor(Errors{9., 3.2, 3.1, 3.}) == std::optional<std::size_t>(1));
  CHECK(first_level_at_floor(Errors{9., 6., 4., 3.}) == std::optional<std::size_t>(3)); // none in sight
  CHECK(first_level_at_floor(Errors{3., 9., 3., 3.}) == std::optional<std::size_t>(2)); // the first is chance
}

TEST_CASE("a level without an error is not passed over, and without the last there is no floor") {
  CHECK(first_level_at_floor(Errors{3., std::nullopt, 3., 3.}) == std::optional<std::size_t>(2));
  CHECK_FALSE(first_level_at_floor(Errors{3., 3., std::nullopt}));
  CHECK_FALSE(first_level_at_floor({}));
}

TEST_CASE("the fastest is named with its factor over the other family") {
  const std::string sentence = fastest_sentence(three_points, 10, 0.1);
  CHECK_THAT(sentence, Contains("within 10 %: A (0.5 ms, 8 %) is the fastest"));
  CHECK_THAT(sentence, Contains("10 times as fast as the fastest finite elements, B (5 ms, 9 %)"));
}

TEST_CASE("a family that does not get there is said not to") {
  CHECK_THAT(fastest_sentence(three_points, 1, 0.1),
             Contains("C (50 ms, 0.5 %)") && Contains("no springs get there"));
}

TEST_CASE("an error that no model reaches is said so, with the nearest") {
  CHECK_THAT(fastest_sentence(three_points, 0.2, 0.1),
             Contains("no model gets there") && Contains("C (50 ms"));
}

TEST_CASE("no error below the reference's own uncertainty is judged") {
  CHECK_THAT(fastest_sentence(three_points, 1, 1), Contains("not to be told") && !Contains("fastest"));
  CHECK_THAT(fastest_sentence(three_points, 1, std::nan("")), Contains("not to be told"));
}

TEST_CASE("the most accurate in a time is named, or the fastest when none answers in time") {
  CHECK_THAT(most_accurate_sentence(three_points, 0.001, 0.1),
             Contains("in 1 ms: A (0.5 ms, 8 %) is the most accurate."));
  CHECK_THAT(most_accurate_sentence(three_points, 0.1, 0.6),
             Contains("C (50 ms") && Contains("as far as") && Contains("0.6 %"));
  CHECK_THAT(most_accurate_sentence(three_points, 0.0001, 0.1),
             Contains("no model answers in that time") && Contains("A (0.5 ms"));
}

TEST_CASE("an error that is small by accident is told with what more cells leave of it") {
  std::vector<Point> some = three_points;
  some[0].error_percent = 0.9;
  some[0].more_cells_percent = 2.4;
  CHECK_THAT(fastest_sentence(some, 1, 0.1),
             Contains("A (0.5 ms, 0.9 % by accident, more cells lead to 2.4 %) is the fastest"));
}

TEST_CASE("without any measured model both sentences say so") {
  CHECK_THAT(fastest_sentence({}, 10, 0.1), Contains("no model was measured"));
  CHECK_THAT(most_accurate_sentence({}, 1, 0.1), Contains("no model was measured"));
}

TEST_CASE("where more cells stop helping is told, with the floor") {
  const std::vector<std::string> levels{"2x2x2", "4x4x4", "8x8x8"};
  CHECK_THAT(floor_sentence("S", levels, {9., 3.1, 3.}),
             Contains("more cells than 4x4x4 do not help") && Contains("3 %"));
  CHECK_THAT(floor_sentence("S", levels, {9., 6., 3.}), Contains("no floor in sight"));
  CHECK_THAT(floor_sentence("S", levels, {1., 3.1, 3.}), Contains("the least, 1 %, is that of 2x2x2"));
  CHECK_THAT(floor_sentence("S", levels, {9., 3.1, std::nullopt}), Contains("no floor is known"));
}

TEST_CASE("times are in milliseconds below a second") {
  CHECK(time_text(0.016) == "16 ms");
  CHECK(time_text(0.000123) == "0.123 ms");
  CHECK(time_text(0.9999) == "1 s");
}

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
  CHECK(thinned.front().name == front.front().name);
  CHECK(thinned.back().name == front.back().name);
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
