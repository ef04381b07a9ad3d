#include "compare/sweep/at_rate.hpp"

#include "cases/case/error.hpp"
#include "cases/case/read_case.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fmt/format.h>
#include <sstream>

using namespace springproof;

using Catch::Contains;
using compare::Point;
using compare::Sweep;
using compare::SweepRow;

namespace rates {

namespace {

Point point(double seconds, double error) {
  return {fmt::format("{:g}", seconds), compare::Family::springs, seconds, error};
}

/// A row of the method with so many substeps; without an error it has failed.
SweepRow row(int substeps, double seconds, std::optional<double> error,
             std::optional<double> in_equilibrium = std::nullopt) {
  SweepRow row;
  row.variant.design = cases::Design::hybrid;
  row.variant.cells = {2, 2, 4};
  cases::RealTime steps;
  steps.iterations = 1;
  steps.substeps = substeps;
  row.variant.real_time = steps;
  row.run.first.status = error ? cases::Status::converged : cases::Status::failed;
  row.run.first.message = error ? "" : "does not come to rest";
  if (error) row.run.first_seconds = {seconds};
  row.field_error_percent = error;
  row.in_equilibrium_percent = in_equilibrium;
  return row;
}

Sweep at_60(const std::vector<SweepRow>& rows) {
  Sweep sweep;
  sweep.rate = compare::Rate{60};
  sweep.reference.emplace().field.uncertainty_percent = 0.5;
  sweep.rows = rows;
  return sweep;
}

cases::Case block() {
  return cases::read_case_text(R"(
schema = 1
name = "block"
[body]
shape = "box"
size = [10, 10, 20]
cells = [1, 1, 3]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.25
density = 1000
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [9.81, 0, 0]
[[measure]]
name = "tip"
kind = "displacement"
node = "x+ y+ z+"
component = "x"
[fem]
accuracy = "none"
)",
                               "block.toml");
}

} // namespace

TEST_CASE("points are sorted by the fronts that they are on") {
  const std::vector<Point> points{point(1, 5), point(2, 3), point(3, 4), point(4, 1), point(2, 6)};
  CHECK(compare::order_of_fronts(points, 9) == std::vector<std::size_t>{3, 1, 0, 2, 4});
  CHECK(compare::order_of_fronts(points, 1) == std::vector<std::size_t>{0, 3, 1, 2, 4}); // 0 keeps the time
  CHECK(compare::order_of_fronts({}, 1).empty());
}

TEST_CASE("halving finds the best of all, of which it follows a few through") {
  const int n = 37, n_rounds = 5;
  const auto at_the_end = [](std::size_t c) { // costs and errors that are no order of each other
    const auto number = static_cast<double>(c);
    return point(1 + std::fmod(7 * number, 37), 2 + std::fmod(11 * number, 37));
  };
  std::vector<Point> all;
  for (std::size_t c = 0; c < n; ++c) all.push_back(at_the_end(c));
  int n_followed = 0;
  std::vector<std::size_t> dropped;
  const auto found = compare::halve(
      n, {n_rounds, 1e9,
          [&](std::size_t c, int round) -> std::optional<Point> {
            if (c % 5 == 1) return std::nullopt; // fails
            if (round + 1 == n_rounds) ++n_followed;
            Point early = at_the_end(c); // a short run errs by less or more
            early.error_percent *= 1 + (c % 2 == 0 ? 0.2 : -0.2) * (n_rounds - 1 - round) / n_rounds;
            return early;
          },
          [](int) { return true; }, [&](std::size_t c, const std::string&) { dropped.push_back(c); }});
  std::size_t best = n;
  for (std::size_t c = 0; c < n; ++c)
    if (c % 5 != 1 && (best == n || all[c].error_percent < all[best].error_percent)) best = c;
  REQUIRE(!found.empty());
  CHECK(std::any_of(found.begin(), found.end(), [&](const auto& one) { return one.first == best; }));
  CHECK(n_followed == 4); // 29 are halved three times: 15, 8, 4
  CHECK(dropped.size() + found.size() == 29);
}

TEST_CASE("halving without time follows one candidate through, and says why not the others") {
  std::vector<std::string> reasons;
  const auto found = compare::halve(
      4, {2, 1e9, [](std::size_t c, int) { return std::optional(point(1 + double(c), 1)); },
          [](int) { return false; }, [&](std::size_t, const std::string& why) { reasons.push_back(why); }});
  CHECK(found.size() == 1);
  REQUIRE(reasons.size() == 3);
  CHECK(reasons[0] == "the budget of round 1 of 2 was spent");
}

TEST_CASE("halving goes back to those that it left behind where the better half fails in the end") {
  std::vector<std::size_t> dropped;
  const auto found = compare::halve(
      8, {3, 1e9,
          [](std::size_t c, int round) {
            return round == 2 && c < 6 ? std::nullopt : std::optional(point(1 + double(c), 1 + double(c)));
          },
          [](int) { return true; }, [&](std::size_t c, const std::string&) { dropped.push_back(c); }});
  REQUIRE(found.size() == 1); // the worst half goes in the first round
  CHECK(found[0].first == 6);
  CHECK(dropped == std::vector<std::size_t>{7});
}

TEST_CASE("the sentence at a rate has the figures of its rows") {
  const Sweep sweep = at_60({row(1, 1e-3, 20), row(5, 4e-3, 12, 11.), row(10, 9e-3, 8, 14.),
                             row(20, 0.025, 3), row(40, 0.05, std::nullopt)});
  const std::string sentence = compare::rate_sentence(sweep);
  CHECK_THAT(sentence,
             Contains("at 60 Hz on this machine (") &&
                 Contains("use springs hybrid, 2x2x4 cells, xpbd, 1 iteration, 10 substeps, which errs by "
                          "8 % by accident (its springs in equilibrium by 14 %) at 9 ms a frame") &&
                 Contains("next best is springs hybrid, 2x2x4 cells, xpbd, 1 iteration, 20 substeps, "
                          "which errs by 3 % at 25 ms a frame, too long"));
  CHECK_THAT(
      compare::rate_sentence(at_60({row(1, 1e-3, 20), row(5, 4e-3, 0.3)})),
      Contains("5 substeps, which errs by less than the reference's uncertainty of 0.5 % at 4 ms") &&
          Contains("next best is springs hybrid, 2x2x4 cells, xpbd, 1 iteration, 1 substep, which errs "
                   "by 20 % at 1 ms a frame"));
  std::ostringstream screen;
  compare::write_sweep_screen(screen, sweep, "");
  CHECK_THAT(screen.str(),
             Contains("           9       yes        8  springs hybrid  2x2x4  xpbd      1        10\n") &&
                 Contains("          25        no        3  springs hybrid") &&
                 Contains("does not come to rest"));
}

TEST_CASE("where nothing keeps a rate, or nothing answers, the sentence says so") {
  CHECK_THAT(compare::rate_sentence(at_60({row(1, 0.02, 20), row(5, 0.03, 3)})),
             Contains("nothing that was tried keeps up; the fastest is springs hybrid, 2x2x4 cells, xpbd, 1 "
                      "iteration, 1 substep, which errs by 20 % at 20 ms a frame"));
  CHECK_THAT(compare::rate_sentence(at_60({row(1, 0.02, std::nullopt)})),
             Contains("nothing that was tried answers"));
  CHECK_FALSE(compare::has_answer(at_60({row(1, 0.02, std::nullopt)})));
}

TEST_CASE("a sweep at a rate has rows that keep it, or that say why not") {
  const auto ignore = [](const Sweep&) {};
  const auto quick = compare::Extent::quick;
  const Sweep sweep = compare::sweep_at_rate(block(), {60, 0.5}, quick, ignore);
  CHECK(compare::has_answer(sweep));
  for (const SweepRow& one : sweep.rows) {
    CAPTURE(full_name(one.variant));
    CHECK(one.field_error_percent.has_value() == (one.run.first.status == cases::Status::converged));
    CHECK((one.field_error_percent || !one.run.first.message.empty()));
  }
  // Elements are followed, or it is said why not.
  const auto is_of_elements = [](const std::string& name) {
    return name.find("q1_bbar elements, ") == 0 && name.find("fem.corotational") != std::string::npos;
  };
  CHECK((std::any_of(sweep.rows.begin(), sweep.rows.end(),
                     [&](const SweepRow& one) { return is_of_elements(full_name(one.variant)); }) ||
         std::any_of(sweep.plan.left_out.begin(), sweep.plan.left_out.end(),
                     [&](const compare::LeftOut& one) { return is_of_elements(one.what); })));
  CHECK(std::any_of(sweep.plan.left_out.begin(), sweep.plan.left_out.end(), [](const compare::LeftOut& one) {
    return one.what == "fem.xpbd" && one.reason.find("tetrahedra") != std::string::npos;
  }));
  CHECK_THAT(compare::rate_sentence(sweep), Contains(" cells, ") && Contains(" a frame"));
  const auto document = compare::sweep_to_json(sweep);
  CHECK(document["at_hertz"] == 60);
  CHECK(document["rows"].size() == sweep.rows.size());
  CHECK(document["conclusions"].size() == 1);

  cases::Case other = block();
  other.material_dynamics.density.reset();
  CHECK_THROWS_WITH(compare::sweep_at_rate(other, {60, 1}, quick, ignore),
                    Contains("material.density") && Contains("--set material.density=1000"));
}

} // namespace rates
