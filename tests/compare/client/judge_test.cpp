#include "compare/client/judge.hpp"

#include "cases/case/read_case.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace {

/// A block of 1 mm, so stiff that it rests at once where implicit Euler steps it.
cases::Scene block() {
  const TemporaryFolder folder;
  return cases::make_scene(cases::read_case(folder.write("block.toml", R"(schema = 1
name = "block"
[body]
shape = "box"
size = [1, 1, 1]
cells = [2, 2, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.25
density = 1000
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0.002, 0, 0]
[fem]
accuracy = "none"
[[measure]]
name = "top"
kind = "displacement"
node = "x+ y+ z+"
component = "x"
)")));
}

} // namespace

TEST_CASE(
    "our springs in real time that have no time to rest are moving, by their mean places, as a client") {
  const compare::Judge judge(block(), 0);
  compare::ClientBudget budget;
  budget.model_time = 0.3; // below the half second that tells rest
  const compare::JudgedRow row =
      judge.step(compare::steps_in(cases::StepMethod::implicit_euler, budget), budget);
  CHECK(row.failure.empty());
  CHECK(row.status() == "moving");
  CHECK_FALSE(row.rests_after);
  CHECK(row.milliseconds_a_step.value_or(0) > 0);
  REQUIRE_FALSE(row.warnings.empty());
  CHECK(row.warnings.back() == "still moves after 0.3 s; these are its mean places from 0.15 s on");
  const compare::JudgedRow springs = judge.own(budget).rows.at(1);
  REQUIRE(row.measures.size() == 1);
  CHECK(*row.measures[0].msm == Approx(*springs.measures.at(0).msm).epsilon(1e-6)); // Newton's tolerance
  budget.model_time = 20;
  const compare::JudgedRow at_rest =
      judge.step(compare::steps_in(cases::StepMethod::implicit_euler, budget), budget);
  CHECK(at_rest.status() == "answered");
  REQUIRE(at_rest.rests_after);
  CHECK(*at_rest.rests_after <= 1); // at the first or second look
}

TEST_CASE("our springs in real time end with the time that an answer may take") {
  compare::ClientBudget budget;
  budget.seconds = 0;
  const compare::JudgedRow row =
      compare::Judge(block(), 0).step(compare::steps_in(cases::StepMethod::xpbd, budget), budget);
  CHECK(row.status() == "failed");
  CHECK_THAT(row.failure, Catch::Contains("it was stopped: it took longer than 0 s"));
}

TEST_CASE("elements that a method steps are a row, which comes to rest near the elements in equilibrium",
          "[long]") {
  compare::ClientBudget budget;
  budget.iterations = 30;
  for (const auto method :
       {cases::ElementMethod::corotational, cases::ElementMethod::total_lagrangian_explicit}) {
    const bool is_corotational = method == cases::ElementMethod::corotational;
    cases::Scene scene = block();
    if (!is_corotational) scene.definition.fem.element = cases::Element::q1; // what it steps
    const compare::Judge judge(scene, 0);
    const double springs = std::abs(judge.own(budget).rows.at(1).worst.value());
    const compare::JudgedRow row = judge.step(compare::steps_in(method, budget), budget);
    CAPTURE(row.model, row.failure);
    CHECK(row.status() == "answered");
    REQUIRE(row.client);
    CHECK(row.model == "fem." + cases::name_of(method));
    CHECK(row.worst.value() != 0);
    CHECK(std::abs(row.worst.value()) < springs / 2);
    CHECK(compare::row_to_json(row)["client"]["settings"]["element"] == (is_corotational ? "q1_bbar" : "q1"));
  }
  const compare::JudgedRow refused =
      compare::Judge(block(), 0).step(compare::steps_in(cases::ElementMethod::xpbd, budget), budget);
  CHECK(refused.status() == "failed");
  CHECK(refused.failure == "fem.xpbd cannot step the case: the body must be a mesh of tetrahedra");
}

TEST_CASE("methods of both models have names of their own") {
  for (const std::string& name : compare::method_names())
    CHECK(compare::name_of(compare::method_called(name).value()) == name);
  CHECK_FALSE(compare::method_called("fem.projective_dynamics"));
  CHECK_FALSE(compare::method_called("corotational"));
  CHECK_THROWS_WITH(compare::method_of("fem.total_lagrangian_explicit:3", {}),
                    Catch::Contains("is explicit and has no iterations"));
}
