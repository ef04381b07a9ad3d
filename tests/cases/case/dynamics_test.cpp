#include "cases/case/dynamics.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace cases;

TEST_CASE("a factor without points is 1 at all times") {
  const History always;
  CHECK(always.at(0) == 1);
  CHECK(always.just_before(7) == 1);
  CHECK_FALSE(always.jumps());
}

TEST_CASE("a factor is linear between its points and constant beyond them") {
  const History ramp{{{1, 2}, {3, 4}}};
  CHECK(ramp.at(0) == 2);
  CHECK(ramp.at(1) == 2);
  CHECK(ramp.at(1.5) == 2.5);
  CHECK(ramp.at(3) == 4);
  CHECK(ramp.at(9) == 4);
  for (const double time : {0., 1., 1.5, 3., 9.}) CHECK(ramp.just_before(time) == ramp.at(time));
  CHECK_FALSE(ramp.jumps());
}

TEST_CASE("at a jump a factor has what comes after it, and just before it what comes before") {
  const History released{{{0, 1}, {0, 0}}}, pulse{{{0, 0}, {1, 1}, {1, -2}, {2, -2}, {2, 0}}};
  CHECK(released.just_before(0) == 1);
  CHECK(released.at(0) == 0);
  CHECK(released.at(1) == 0);
  CHECK(pulse.just_before(1) == 1);
  CHECK(pulse.at(1) == -2);
  CHECK(pulse.at(1.5) == -2);
  CHECK(pulse.just_before(2) == -2);
  CHECK(pulse.at(2) == 0);
  CHECK(released.jumps());
  CHECK(pulse.jumps());
}

TEST_CASE("a sine has its frequency in Hz, and begins at 0") {
  History sine;
  sine.frequency = 2;
  CHECK(sine.at(0) == 0);
  CHECK(sine.at(0.125) == Approx(1));
  CHECK(sine.just_before(0.375) == Approx(-1));
  CHECK_FALSE(sine.jumps());
}

TEST_CASE("the number of steps is whole, whatever rounding makes of the quotient") {
  Dynamics motion;
  motion.step = 0.1;
  motion.end = 0.3; // 2.9999999999999996 steps
  CHECK(motion.n_steps() == 3);
}
