#include "mechanics/equilibrium/find_equilibrium.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("load steps turn a support by 30 degrees at most, and leave room for halving") {
  const auto steps_of = [](double degrees, double from, double to) {
    mechanics::EquilibriumSettings settings;
    settings.from = from;
    settings.to = to;
    settings.smallest_load_step = 0.1;
    return mechanics::in_small_turns(degrees, 1, settings);
  };
  CHECK(steps_of(0, 0, 1).largest_load_step == 1);
  CHECK(steps_of(30, 0, 1).first_load_step == 1);
  for (const double degrees : {31., 270., -300., 360., 720., 1e6}) {
    const auto settings = steps_of(degrees, 0, 1);
    CHECK(settings.largest_load_step * std::abs(degrees) <= 30);
    CHECK(settings.largest_load_step * std::abs(degrees) > 15);
    CHECK(settings.first_load_step == settings.largest_load_step);
    CHECK(settings.smallest_load_step <= settings.largest_load_step / 10);
  }
  CHECK(steps_of(300, 0.5, 0.6).largest_load_step == 1); // 30 degrees of the way
}

TEST_CASE("load steps that are smaller already stay as they are") {
  mechanics::EquilibriumSettings settings;
  settings.first_load_step = 0.01;
  settings.largest_load_step = 0.02;
  const auto turned = mechanics::in_small_turns(90, 1, settings);
  CHECK(turned.first_load_step == 0.01);
  CHECK(turned.largest_load_step == 0.02);
}
