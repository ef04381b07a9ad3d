#include "compare/solve/progress.hpp"

#include <catch2/catch.hpp>

using springproof::compare::clock_text;
using springproof::compare::Remaining;
using springproof::compare::told_first;
using springproof::compare::told_next;

TEST_CASE("without a terminal, work of more than a minute is told of at its beginning or when the minute is "
          "over, and "
          "again and again") {
  CHECK(told_first(61) == 0);
  CHECK(told_first(59) == 60);
  CHECK(told_next(0) == 60);
  CHECK(told_next(60) == 120);
  CHECK(told_next(120) == 240);
}

TEST_CASE("before anything is finished, what is left is what was estimated") {
  Remaining r;
  r.expected = {4, 100};
  CHECK(r.seconds() == Approx(100));
  r.n_workers = 2;
  CHECK(r.seconds() == Approx(50));
  CHECK(r.part_done() == 0);
}

TEST_CASE("what took longer than estimated makes the rest longer too") {
  Remaining r;
  r.expected = {2, 2000};
  r.finished = {1, 1000};
  r.took = 3000;
  CHECK(r.seconds() ==
        Approx(3000).epsilon(0.01)); // two seconds of work count as if they had been as estimated
  CHECK(r.part_done() == Approx(0.5).epsilon(0.01));
  r.finished.seconds = 0.001; // one short piece says little
  r.took = 0.1;
  CHECK(r.correction() < 1.1);
}

TEST_CASE("a piece that runs beyond its estimate leaves no time below zero") {
  Remaining r;
  r.expected = {1, 10};
  r.of_running = 10;
  r.running_since = 4;
  CHECK(r.seconds() == Approx(6));
  r.running_since = 400;
  CHECK(r.seconds() == 0);
  CHECK(r.part_done() == 1);
  CHECK(Remaining{}.part_done() == 0);
}

TEST_CASE("times are minutes and seconds, with hours where there are some") {
  CHECK(clock_text(0) == "0:00");
  CHECK(clock_text(59.6) == "1:00");
  CHECK(clock_text(725) == "12:05");
  CHECK(clock_text(3723) == "1:02:03");
}
