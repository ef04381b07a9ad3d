#include "compare/write/write.hpp"

#include "tests/compare/gates/judged.hpp"

#include "cases/case/names.hpp"

#include <catch2/catch.hpp>
#include <functional>
#include <limits>

using namespace springproof;

using cases::Quantity;
using cases::ReferenceKind;
using compare::Comparison;
using judged::comparison;
using judged::expectation;

TEST_CASE("a case that expects nothing does not pass its gates") {
  const auto result = judged::judge(comparison({}));
  CHECK_FALSE(result.met());
  REQUIRE(result.failures().size() == 1);
  CHECK_THAT(result.failures()[0], Catch::Contains("expects nothing"));
  CHECK_FALSE(compare::all_met({judged::judge(comparison({expectation(Quantity::fem, {9, 11})})), result}));
}

TEST_CASE("a gate has the unit of what it bounds, and says in words where the value lies") {
  const auto result = judged::judge(
      comparison({expectation(Quantity::error_percent, {-10, 0}), expectation(Quantity::msm, {9.5, 10})}));
  REQUIRE(result.gates.size() == 2);
  CHECK(result.gates[0].met());
  CHECK(result.gates[0].unit == "%");
  CHECK(describe(result.gates[0]) == "L error_percent = -10 %, in [-10, 0]");
  CHECK_FALSE(result.gates[1].met());
  CHECK(describe(result.gates[1]) == "L msm = 9 mm, not in [9.5, 10]");
  CHECK_FALSE(result.met());
}

TEST_CASE("a solve that failed fails its case, even when nothing was expected of that side") {
  auto failed = comparison({expectation(Quantity::msm, {8, 10}), expectation(Quantity::fem, {9, 11})});
  failed.answers.fem.solution.status = cases::Status::failed;
  failed.answers.fem.solution.message = "limit point";
  failed.answers.fem.solution.load_reached = 0.25;
  failed.measures[0].fem = failed.measures[0].error_percent = std::nullopt;
  const auto result = judged::judge(failed);
  CHECK(result.gates[0].met());
  CHECK_FALSE(result.gates[1].met());
  CHECK(reason_of(result.gates[1]) == "fem failed at 0.25 of the load: limit point");
  CHECK(result.failures() == std::vector<std::string>{"fem failed at 0.25 of the load: limit point"});
  CHECK_FALSE(result.met());
}

TEST_CASE("the reference's error bar is shown in the gate's unit, and moves no gate but a converged one's") {
  // 2 % of 10 mm are 0.2 mm; of an error of -10 % they are 0.02 (100 - 10) = 1.8 points.
  const auto sure = judged::judge(judged::with_limit(
      comparison({expectation(Quantity::fem, {9, 9.99}), expectation(Quantity::error_percent, {-9.9, 0}),
                  expectation(Quantity::error_percent, {-11, 0}), expectation(Quantity::msm, {8, 10})}),
      2));
  CHECK(sure.gates[0].uncertainty.value() == Approx(0.2).epsilon(1e-12)); // rounding
  CHECK(sure.gates[1].uncertainty.value() == Approx(1.8).epsilon(1e-12));
  CHECK(sure.gates[2].met());             // -10, though the bar reaches to -11.8
  CHECK_FALSE(sure.gates[3].uncertainty); // the springs' value needs no reference
  CHECK_FALSE(sure.gates[0].met());       // 10 lies outside, though within the error bar
  CHECK_FALSE(sure.gates[1].met());
  for (const auto& gate : sure.gates) CHECK_FALSE(gate.is_undecided);
  CHECK(sure.gates[0].warning.empty());
}

TEST_CASE("an interval narrower than the error bar warns, a wider one does not") {
  const auto warning_of_width = [](double width) {
    const auto expected = expectation(Quantity::fem, {10 - width / 2, 10 + width / 2});
    return judged::judge(judged::studied(comparison({expected}), 2)).gates[0].warning;
  };
  CHECK_THAT(warning_of_width(0.39),
             Catch::Contains("narrower than the reference's own error bar, +- 0.2 mm"));
  CHECK(warning_of_width(0.41).empty());
}

TEST_CASE(
    "a gate against a converged reference is met, missed or undecided by value and uncertainty together") {
  const auto judged_in = [](Quantity quantity, double lower, double upper) {
    return judged::judge(
               judged::with_limit(
                   comparison({expectation(quantity, {lower, upper}, ReferenceKind::converged)}), 2))
        .gates[0];
  };
  // -10 +- 1.8 %
  CHECK(judged_in(Quantity::error_percent, -12, -8).met());
  for (const auto& [lower, upper] :
       {std::pair(-11., -8.), std::pair(-12., -9.), std::pair(-9., 0.), std::pair(-20., -11.)}) {
    const auto gate = judged_in(Quantity::error_percent, lower, upper);
    CAPTURE(lower, upper);
    CHECK_FALSE(gate.met());
    CHECK(gate.is_undecided);
    CHECK_THAT(describe(gate), Catch::Contains("undecided: -10 +- 1.8") && Catch::Contains("--converge=4") &&
                                   Catch::Contains("8e+04 unknowns"));
  }
  const auto outside = judged_in(Quantity::error_percent, -8, 0);
  CHECK_FALSE(outside.met());
  CHECK_FALSE(outside.is_undecided);
  CHECK(describe(outside) == "L error_percent = -10 %, not in [-8, 0]");
  CHECK(judged_in(Quantity::fem, 9.7, 10.3).met()); // the limit, 10 +- 0.2 mm
  CHECK(judged_in(Quantity::fem, 9.9, 10.3).is_undecided);
  CHECK(judged_in(Quantity::msm, 9, 9).met()); // needs no reference
}

TEST_CASE("a requirement holds for all that a limit leaves open, and needs none") {
  const auto required = [](double lower) {
    return comparison({expectation(Quantity::error_percent, {lower, -8}, ReferenceKind::requirement)});
  };
  const auto of_limit = [&](double lower) { // -10 +- 1.8 %
    return judged::judge(judged::with_limit(required(lower), 2)).gates[0];
  };
  CHECK(of_limit(-12).met());
  CHECK(of_limit(-11).is_undecided);
  CHECK(judged::judge(required(-11)).gates[0].met()); // against the same mesh
}

TEST_CASE("a gate on results that were interpolated holds for what that may add") {
  const auto judged_in = [](Quantity quantity, double lower, double upper) {
    auto result = comparison({expectation(quantity, {lower, upper})});
    result.answers.interpolated.emplace();
    result.measures[0].interpolation_error = 0.2; // mm
    result.measures[0].interpolation_error_percent = 2;
    return judged::judge(result).gates[0];
  };
  CHECK(judged_in(Quantity::error_percent, -12.1, -7.9).met());
  CHECK(judged_in(Quantity::error_percent, -11, -7.9).is_undecided);
  CHECK(judged_in(Quantity::error_percent, -9, 0).is_undecided);
  CHECK_FALSE(judged_in(Quantity::error_percent, -7, 0).met());
  CHECK(judged_in(Quantity::msm, 8.7, 9.3).met());
  const auto open = judged_in(Quantity::msm, 8.9, 9.3);
  CHECK_FALSE(open.met());
  CHECK_THAT(describe(open),
             Catch::Contains("undecided: 9 +- 0.2") && Catch::Contains("the case's own mesh"));
  CHECK(open.uncertain == "interpolation");
  CHECK(judged_in(Quantity::fem, 10, 10).met()); // nothing of the finite elements was interpolated
}

// The springs' own value was "met converged" without a limit that anybody had looked for. Looked for the same
// kind: every quantity beside every kind of reference; the others need no more than their own value.
TEST_CASE("no quantity is met against a converged reference that is not there, the springs' own neither") {
  for (const auto quantity : {Quantity::msm, Quantity::fem, Quantity::error_percent}) {
    INFO(cases::name_of(quantity));
    const auto expected = expectation(quantity, {-100, 100}, ReferenceKind::converged);
    const auto without = judged::judge(comparison({expected}));
    CHECK_FALSE(without.gates[0].met());
    CHECK_FALSE(without.is_sound());
    CHECK_THAT(describe(without.gates[0]), Catch::Contains("no converged reference: no mesh study was made"));
    auto studied = judged::studied(comparison({expected}), 2);
    studied.mesh_study->measures[0].no_reference = "the values do not draw nearer";
    CHECK_THAT(describe(judged::judge(studied).gates[0]),
               Catch::Contains("no converged reference: the values do not draw nearer"));
    CHECK(judged::judge(judged::with_limit(comparison({expected}), 2)).gates[0].met());
    auto alone = comparison({expected}); // run --only msm
    alone.answers.fem.solution.status = cases::Status::skipped;
    alone.measures[0] = {"L", "mm", {}, 9.0, {}};
    const auto springs = judged::judge(alone);
    CHECK(springs.gates[0].is_left_out);
    CHECK(springs.is_sound());
    CHECK_FALSE(springs.met());
    CHECK_THAT(describe(springs.gates[0]), Catch::Contains("fem was not asked for"));
  }
  auto outside = comparison({expectation(Quantity::msm, {0, 1}, ReferenceKind::converged)});
  outside.answers.fem.solution.status = cases::Status::skipped;
  CHECK_FALSE(judged::judge(outside).is_sound()); // whatever the reference
}

TEST_CASE(
    "a side with inverted cells or in an unstable equilibrium fails its case, unless that is accepted") {
  const auto doubtful = [](const std::vector<cases::Doubt>& accepted) {
    auto result = comparison({expectation(Quantity::fem, {9, 11})});
    result.answers.msm.solution.inverted_cells = 3;
    result.answers.fem.solution.negative_eigenvalues = 1;
    result.scene.definition.msm.accepted = result.scene.definition.fem.accepted = accepted;
    return judged::judge(result);
  };
  const auto refused = doubtful({});
  REQUIRE(refused.doubts().size() == 2);
  CHECK_THAT(refused.doubts()[0], Catch::Contains("fem is in an unstable equilibrium"));
  CHECK_THAT(refused.doubts()[1], Catch::Contains("msm has 3 inverted cells"));
  CHECK_FALSE(refused.is_sound());
  CHECK_FALSE(refused.met());
  CHECK_FALSE(doubtful({cases::Doubt::inverted}).met());
  CHECK(doubtful({cases::Doubt::inverted, cases::Doubt::unstable}).met());
  CHECK(judged::judge(comparison({})).is_sound()); // what expects nothing is no failure of run
}

TEST_CASE("a gate without a value is never met, whatever the reason, and the reason is told") {
  const auto nan = std::numeric_limits<double>::quiet_NaN(),
             infinite = std::numeric_limits<double>::infinity();
  struct Missing {
    std::string reason; ///< part of it
    std::function<void(Comparison&)> remove;
  };
  const std::vector<Missing> all{
      {"no finite value",
       [&](Comparison& c) {
         c.measures[0] = {"L", "mm", nan, nan, nan};
       }},
      {"no finite value",
       [&](Comparison& c) {
         c.measures[0] = {"L", "mm", infinite, -infinite, infinite};
       }},
      {"it does not swing",
       [](Comparison& c) {
         c.measures[0] = {"L", "Hz", {}, {}, {}};
         c.measures[0].fem_reason = c.measures[0].msm_reason = "it does not swing";
       }},
      {"failed at 0.25 of the load: limit point",
       [](Comparison& c) {
         for (compare::Answer* side : {&c.answers.fem, &c.answers.msm}) {
           side->solution.status = cases::Status::failed;
           side->solution.load_reached = 0.25;
           side->solution.message = "limit point";
         }
         c.measures[0] = {"L", "mm", {}, {}, {}};
       }},
      {"was not asked for",
       [](Comparison& c) {
         c.answers.fem.solution.status = c.answers.msm.solution.status = cases::Status::skipped;
         c.measures[0] = {"L", "mm", {}, {}, {}};
       }},
      {"there is no such measure", [](Comparison& c) { c.measures.clear(); }},
  };
  constexpr double most = std::numeric_limits<double>::max();
  for (const auto quantity : {Quantity::fem, Quantity::msm, Quantity::error_percent})
    for (const Missing& missing : all) {
      INFO(cases::name_of(quantity) << ": " << missing.reason);
      auto without = comparison({expectation(quantity, {-most, most})}); // which holds every number
      missing.remove(without);
      const auto judged = judged::judge(without);
      REQUIRE(judged.gates.size() == 1);
      CHECK_FALSE(judged.gates[0].met());
      CHECK_FALSE(judged.gates[0].value);
      CHECK_FALSE(judged.met());
      CHECK(judged.is_sound() == (missing.reason == "was not asked for"));
      // a percentage without a value is known only not to be finite
      const bool is_of_both = quantity == Quantity::error_percent && missing.reason == "no finite value";
      CHECK_THAT(describe(judged.gates[0]), Catch::Contains(is_of_both ? "not finite" : missing.reason));
    }
  auto zero = comparison({expectation(Quantity::error_percent, {-most, most})});
  zero.measures[0] = {"L", "mm", 0.0, 9.0, {}};
  CHECK_FALSE(judged::judge(zero).met());
  CHECK_FALSE(judged::judge(zero).is_sound());
  CHECK_THAT(describe(judged::judge(zero).gates[0]), Catch::Contains("the reference is zero"));
}

TEST_CASE("a gate that needs a side that was not asked for is not judged, one of the other side is") {
  const auto springs_alone = [](const std::function<void(Comparison&)>& change) {
    auto result =
        comparison({expectation(Quantity::msm, {8, 10}), expectation(Quantity::error_percent, {-11, 0}),
                    expectation(Quantity::fem, {9, 11})});
    result.answers.fem.solution.status = cases::Status::skipped;
    result.measures[0] = {"L", "mm", {}, 9.0, {}};
    change(result);
    return judged::judge(result);
  };
  const auto left_out = [](const Comparison& judged) {
    std::vector<bool> all;
    for (const compare::Gate& gate : judged.gates) all.push_back(gate.is_left_out);
    return all;
  };
  const auto explored = springs_alone([](Comparison&) {});
  CHECK(left_out(explored) == std::vector<bool>{false, true, true});
  CHECK(explored.gates[0].met());
  CHECK(explored.is_sound());  // the success of run --only
  CHECK_FALSE(explored.met()); // not of gate
  CHECK(describe(explored.gates[1]) == "L error_percent: fem was not asked for");

  const auto outside = springs_alone([](Comparison& c) { c.measures[0].msm = 7; });
  CHECK_FALSE(outside.is_sound());
  const auto does_not_swing = springs_alone([](Comparison& c) {
    c.measures[0].msm.reset();
    c.measures[0].msm_reason = "it does not swing";
  });
  CHECK(left_out(does_not_swing) == std::vector<bool>{false, false, true});
  CHECK_FALSE(does_not_swing.is_sound());
  CHECK(reason_of(does_not_swing.gates[1]) == "fem was not asked for; msm: it does not swing");
  CHECK_FALSE(springs_alone([](Comparison& c) { c.measures[0].name = "M"; }).is_sound());
}
