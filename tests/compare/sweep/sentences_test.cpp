#include "compare/sweep/analysis.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace compare;
using Catch::Contains;

namespace {

const std::vector<Point> points{{"A", Family::springs, 0.0005, 8},
                                {"B", Family::finite_elements, 0.005, 9},
                                {"C", Family::finite_elements, 0.05, 0.5}};

} // namespace

TEST_CASE("the fastest is named with its factor over the other family") {
  const std::string sentence = fastest_sentence(points, 10, 0.1);
  CHECK_THAT(sentence, Contains("within 10 %: A (0.5 ms, 8 %) is the fastest"));
  CHECK_THAT(sentence, Contains("10 times as fast as the fastest finite elements, B (5 ms, 9 %)"));
}

TEST_CASE("a family that does not get there is said not to") {
  CHECK_THAT(fastest_sentence(points, 1, 0.1),
             Contains("C (50 ms, 0.5 %)") && Contains("no springs get there"));
}

TEST_CASE("an error that no model reaches is said so, with the nearest") {
  CHECK_THAT(fastest_sentence(points, 0.2, 0.1), Contains("no model gets there") && Contains("C (50 ms"));
}

TEST_CASE("no error below the reference's own uncertainty is judged") {
  CHECK_THAT(fastest_sentence(points, 1, 1), Contains("not to be told") && !Contains("fastest"));
  CHECK_THAT(fastest_sentence(points, 1, std::nan("")), Contains("not to be told"));
}

TEST_CASE("the most accurate in a time is named, or the fastest when none answers in time") {
  CHECK_THAT(most_accurate_sentence(points, 0.001, 0.1),
             Contains("in 1 ms: A (0.5 ms, 8 %) is the most accurate."));
  CHECK_THAT(most_accurate_sentence(points, 0.1, 0.6),
             Contains("C (50 ms") && Contains("as far as") && Contains("0.6 %"));
  CHECK_THAT(most_accurate_sentence(points, 0.0001, 0.1),
             Contains("no model answers in that time") && Contains("A (0.5 ms"));
}

TEST_CASE("an error that is small by accident is told with what more cells leave of it") {
  std::vector<Point> some = points;
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
