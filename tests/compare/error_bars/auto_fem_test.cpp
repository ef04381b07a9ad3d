#include "compare/error_bars/auto_fem.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using namespace compare;

namespace {

/// A block clamped at its base, sheared by a traction (MPa); the measure is expected within a band of that
/// many per cent.
cases::Case block(double traction, double width) {
  cases::Case definition;
  definition.name = "block";
  definition.body = cases::Box{{2, 2, 2}, {2, 2, 2}};
  definition.material = cases::LinearElastic{1, 0.3};
  definition.fixed.push_back({{"z-", std::nullopt, {}}, {true, true, true}});
  cases::Load load;
  load.region.name = "z+";
  load.kind = cases::LoadKind::traction;
  load.value = {traction, 0, 0};
  definition.loads.push_back(load);
  cases::Measure measure;
  measure.name = "shift";
  measure.kind = cases::MeasureKind::displacement;
  measure.node.name = "z+ x+ y+";
  measure.component = cases::Component::x;
  definition.measures.push_back(measure);
  definition.expectations.push_back({"shift",
                                     cases::Quantity::error_percent,
                                     {-width / 2, width / 2},
                                     cases::ReferenceKind::regression,
                                     "",
                                     {}});
  return definition;
}

double shift(const cases::Scene& scene, const Answer& answer) {
  return answer.solution
      .displacement[static_cast<std::size_t>(
          cases::select_node(scene.mesh, scene.definition.measures[0].node))]
      .x();
}

} // namespace

TEST_CASE("the largest gradient of a uniform deformation is its own norm, on cells of any shape") {
  cases::HexMesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  mesh.nodes[13] += Eigen::Vector3d(0.1, -0.05, 0.08);
  std::vector<Eigen::Vector3d> displacement;
  for (const Eigen::Vector3d& x : mesh.nodes) displacement.emplace_back(0.3 * x.y(), 0, -0.1 * x.z());
  CHECK(largest_gradient(mesh, displacement) == Approx(0.3).epsilon(1e-12)); // rounding
}

TEST_CASE("what an expectation tolerates is a quarter of its width") {
  cases::Expectation percent{"m", cases::Quantity::error_percent, {-3, 5}, cases::ReferenceKind::exact, "",
                             {}};
  CHECK(tolerated_error_percent(percent, 17) == 2);
  cases::Expectation value{"m", cases::Quantity::fem, {9, 11}, cases::ReferenceKind::exact, "", {}};
  CHECK(tolerated_error_percent(value, -10) == 5);
}

TEST_CASE("small strain is chosen for small strains alone, and its solve is the answer") {
  for (const auto& [traction, formulation] :
       {std::pair(1e-3, cases::Formulation::small_strain), std::pair(0.3, cases::Formulation::log_strain)}) {
    cases::Scene scene = cases::make_scene(block(traction, 8));
    scene.definition.fem.has_auto_formulation = true;
    const FemAnswer chosen = solve_fem(scene);
    CHECK(chosen.resolved.formulation == formulation);
    REQUIRE(chosen.choices.size() == 1);
    CHECK_THAT(chosen.choices[0], Catch::Contains("largest displacement gradient"));
    cases::Scene given = cases::make_scene(block(traction, 8));
    given.definition.fem.formulation = formulation;
    CHECK(shift(scene, chosen.answer) == shift(given, solve_fem_as_given(given).answer));
    if (formulation == cases::Formulation::log_strain) continue;
    given.definition.fem.formulation = cases::Formulation::log_strain;
    const double finite = shift(given, solve_fem_as_given(given).answer);
    CHECK(std::abs(shift(scene, chosen.answer) / finite - 1) < 0.02); // what the expectation tolerates
  }
}

TEST_CASE("refinement stops at the first mesh that is accurate enough, and says so when none is",
          "[verification]") {
  cases::Case definition = block(1e-3, 0);
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.refine = 3;
  cases::Scene reference = cases::make_scene(definition);
  const double limit = shift(reference, solve_fem_as_given(reference).answer);
  definition.fem.refine = 0;
  definition.fem.has_auto_accuracy = true;
  int last = -1;
  for (const double width : {100., 40., 10.}) {
    definition.expectations[0].interval = {0, width};
    const cases::Scene scene = cases::make_scene(definition);
    const FemAnswer fem = solve_fem(scene);
    CAPTURE(width, fem.choices);
    CHECK(fem.resolved.refine >= last);
    CHECK(100 * std::abs(shift(scene, fem.answer) / limit - 1) < width / 4);
    last = fem.resolved.refine;
  }
  CHECK(last > 1);
  definition.loads[0].kind = cases::LoadKind::nodal_force; // has no limit
  const FemAnswer fem = solve_fem(cases::make_scene(definition));
  CHECK(fem.resolved.refine == 0);
  REQUIRE(fem.choices.size() == 1);
  CHECK_THAT(fem.choices[0], Catch::Contains("no continuum limit"));
}
