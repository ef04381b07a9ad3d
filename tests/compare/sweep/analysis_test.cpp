#include "compare/sweep/analysis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;
using namespace compare;
using Indices = std::vector<std::size_t>;
using Errors = std::vector<std::optional<double>>;
using Catch::Contains;

namespace {

Point springs_at(double seconds, double error) {
  return {"springs", Family::springs, seconds, error};
}
Point elements_at(double seconds, double error) {
  return {"elements", Family::finite_elements, seconds, error};
}

const std::vector<Point> measured{{"A", Family::springs, 0.0005, 8},
                                  {"B", Family::finite_elements, 0.005, 9},
                                  {"C", Family::finite_elements, 0.05, 0.5}};

} // namespace

TEST_CASE("the Pareto front keeps what nothing beats, in the order of time") {
  CHECK(pareto_front({elements_at(4, 1), springs_at(1, 9), springs_at(2, 10), elements_at(3, 2)}) ==
        Indices{1, 3, 0});
}

TEST_CASE("of points that tie in time or error the Pareto front keeps the better, of equal ones the first") {
  CHECK(pareto_front({springs_at(1, 5), springs_at(1, 3)}) == Indices{1});
  CHECK(pareto_front({springs_at(1, 3), springs_at(2, 3)}) == Indices{0});
  CHECK(pareto_front({springs_at(1, 3), elements_at(1, 3)}) == Indices{0});
}

TEST_CASE("the Pareto front of no point is empty and of one point that point") {
  CHECK(pareto_front({}).empty());
  CHECK(pareto_front({springs_at(1, 0)}) == Indices{0});
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
  CHECK(first_level_at_floor(Errors{3., 9., 3., 3.}) == std::optional<std::size_t>(2)); // by chance before
}

TEST_CASE("a level without an error is not passed over, and without the last there is no floor") {
  CHECK(first_level_at_floor(Errors{3., std::nullopt, 3., 3.}) == std::optional<std::size_t>(2));
  CHECK_FALSE(first_level_at_floor(Errors{3., 3., std::nullopt}));
  CHECK_FALSE(first_level_at_floor({}));
}

TEST_CASE("the fastest is named with its factor over the other family") {
  const std::string sentence = fastest_sentence(measured, 10, 0.1);
  CHECK_THAT(sentence, Contains("within 10 %: A (0.5 ms, 8 %) is the fastest"));
  CHECK_THAT(sentence, Contains("10 times as fast as the fastest finite elements, B (5 ms, 9 %)"));
}

TEST_CASE("a family that does not get there is said not to") {
  CHECK_THAT(fastest_sentence(measured, 1, 0.1),
             Contains("C (50 ms, 0.5 %)") && Contains("no springs get there"));
}

TEST_CASE("an error that no model reaches is said so, with the nearest") {
  CHECK_THAT(fastest_sentence(measured, 0.2, 0.1), Contains("no model gets there") && Contains("C (50 ms"));
}

TEST_CASE("no error below the reference's own uncertainty is judged") {
  CHECK_THAT(fastest_sentence(measured, 1, 1), Contains("not to be told") && !Contains("fastest"));
  CHECK_THAT(fastest_sentence(measured, 1, std::nan("")), Contains("not to be told"));
}

TEST_CASE("the most accurate in a time is named, or the fastest when none answers in time") {
  CHECK_THAT(most_accurate_sentence(measured, 0.001, 0.1),
             Contains("in 1 ms: A (0.5 ms, 8 %) is the most accurate."));
  CHECK_THAT(most_accurate_sentence(measured, 0.1, 0.6),
             Contains("C (50 ms") && Contains("as far as") && Contains("0.6 %"));
  CHECK_THAT(most_accurate_sentence(measured, 0.0001, 0.1),
             Contains("no model answers in that time") && Contains("A (0.5 ms"));
}

TEST_CASE("an error that is small by accident is told with what more cells leave of it") {
  std::vector<Point> some = measured;
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
