#include "mechanics/real_time/colours.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("items of a colour touch nothing in common, and every item has one") {
  const std::vector<std::vector<int>> touched{{0, 1}, {1, 2}, {2, 3}, {0, 3}, {0, 2}};
  CHECK(mechanics::colour(touched, 4) == mechanics::Colours{{0, 2}, {1, 3}, {4}});
}
