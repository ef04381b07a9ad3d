#include "compare/sweep/analysis.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;

namespace {

Point springs_at(double seconds, double error) {
  return {"springs", Family::springs, seconds, error};
}
Point elements_at(double seconds, double error) {
  return {"elements", Family::finite_elements, seconds, error};
}
using Indices = std::vector<std::size_t>;
using Errors = std::vector<std::optional<double>>;

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
