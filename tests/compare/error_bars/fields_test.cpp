// Forces, energy, stress and strain of both models, from the case to the error against the limit.
#include "compare/error_bars/auto_fem.hpp"
#include "compare/error_bars/convergence.hpp"
#include "compare/measure/measure.hpp"
#include "compare/peers/external_side.hpp"
#include "compare/sweep/sweep.hpp"

#include "tests/support/bodies.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;

namespace {

/// A block pulled and sheared by a traction of (0.004, 0, 0.01) MPa on 4 x 4 mm.
cases::Case pulled_block() {
  cases::Case definition = bodies::clamped_box({4, 4, 4}, {});
  definition.loads = {{bodies::region("z+"), cases::loads::Traction{{0.004, 0, 0.01}}}};
  definition.msm.design = cases::Design::hybrid;
  definition.msm.split = 0.8;
  namespace measures = cases::measures;
  const measures::OfCells middle{cases::TensorComponent::zz, {2, 2, 2}};
  definition.measures = {{"pull", measures::Reaction{{"z-"}, cases::Component::z}},
                         {"shove", measures::Reaction{{"z-"}, cases::Component::x}},
                         {"energy", measures::StrainEnergy{}},
                         {"stress", measures::Stress{middle}},
                         {"strain", measures::Strain{middle}}};
  definition.has_fields = true;
  return definition;
}

} // namespace

TEST_CASE("both models' forces, energy, stress and strain are held against the limit", "[verification]") {
  const cases::Scene scene = cases::make_scene(pulled_block());
  Request request;
  request.meshes = 3;
  const Answers answers = solve(scene, request, solve_fem);
  REQUIRE(answers.fem.converged());
  REQUIRE(answers.msm.converged());
  const MeshStudy study = study_meshes(scene, answers.refined.value(), 0);
  const std::vector<MeasuredValue> values = measure(scene, answers, &study);
  REQUIRE(values.size() == 5);
  const double load[2] = {-0.01 * 16, -0.004 * 16}; // the support pulls back
  for (std::size_t i = 0; i < 2; ++i) {
    CAPTURE(values[i].name);
    CHECK(values[i].unit == "N");
    CHECK(*values[i].fem == Approx(load[i]).epsilon(1e-7)); // the solvers' 1e-9 of the load
    CHECK(*values[i].msm == Approx(load[i]).epsilon(1e-7));
    REQUIRE(values[i].fem_limit);
    CHECK(values[i].fem_limit->value == Approx(load[i]).epsilon(1e-7));
    CHECK(std::abs(*values[i].error_percent) <= 1e-5);
  }
  for (std::size_t i = 2; i < 5; ++i) {
    CAPTURE(values[i].name, *values[i].fem, *values[i].msm);
    REQUIRE(values[i].fem_limit);
    REQUIRE(values[i].error_percent);
    REQUIRE(values[i].error_uncertainty_percent);
    CHECK(std::abs(*values[i].error_percent) <= 15); // the hybrid design's, on four cells across
    CHECK(std::abs(*values[i].error_percent) > 1e-4);
  }
  // the stress in the middle of the block is the traction's to a few percent, whatever the model
  CHECK(*values[3].fem == Approx(0.01).epsilon(0.15));
  CHECK(*values[3].msm == Approx(0.01).epsilon(0.15));
}

TEST_CASE("displacements alone have no forces: refused beside them, by name") {
  const cases::Scene scene = cases::make_scene(pulled_block());
  CHECK_THROWS_WITH(read_external({{scene, {}}}, "any.csv", Transfer::matched),
                    Catch::Contains("\"reaction\""));
  CHECK_THROWS_WITH(plan_sweep(scene.definition, Extent::quick), Catch::Contains("\"reaction\""));
  Answers answers = solve(scene, {cases::Side::msm}, solve_fem);
  CHECK(answers.msm.solution.fields);
  answers.msm.solution.fields.reset(); // another program's answer has none
  for (const MeasuredValue& value : measure(scene, answers, nullptr)) CHECK_FALSE(value.msm);
}

TEST_CASE("a case that asks for no fields gets none") {
  cases::Case definition = pulled_block();
  definition.measures.clear();
  definition.has_fields = false;
  const Answers answers = solve(cases::make_scene(definition), {}, solve_fem);
  CHECK_FALSE(answers.fem.solution.fields);
  CHECK_FALSE(answers.msm.solution.fields);
}
