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
  definition.loads.push_back({{"z+"}, cases::loads::Traction{{traction, 0, 0}}});
  definition.measures.push_back({"shift", cases::measures::Displacement{{"z+ x+ y+"}, cases::Component::x}});
  definition.expectations.push_back({"shift",
                                     cases::Quantity::error_percent,
                                     {-width / 2, width / 2},
                                     cases::ReferenceKind::regression,
                                     "",
                                     {}});
  return definition;
}

double shift(const cases::Scene& scene, const Answer& answer) {
  return answer.solution.displacement[static_cast<std::size_t>(cases::select_node(scene.mesh, {"z+ x+ y+"}))]
      .x();
}

} // namespace

TEST_CASE("the largest gradient of a uniform deformation is its own norm, on cells of any shape") {
  cases::Mesh mesh = cases::make_box_mesh({2, 2, 2}, {2, 2, 2});
  mesh.nodes.stored()[13] += Eigen::Vector3d(0.1, -0.05, 0.08);
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
    const Answers chosen = solve_fem(scene, 0);
    CHECK(chosen.resolved.formulation == formulation);
    REQUIRE(chosen.choices.size() == 1);
    CHECK_THAT(chosen.choices[0], Catch::Contains("largest displacement gradient"));
    cases::Scene given = cases::make_scene(block(traction, 8));
    given.definition.fem.formulation = formulation;
    CHECK(shift(scene, chosen.fem) == shift(given, solve_fem_as_given(given)));
    if (formulation == cases::Formulation::log_strain) continue;
    given.definition.fem.formulation = cases::Formulation::log_strain;
    const double finite = shift(given, solve_fem_as_given(given));
    CHECK(std::abs(shift(scene, chosen.fem) / finite - 1) < 0.02); // what the expectation tolerates
  }
}

TEST_CASE(
    "refinement stops at the first mesh that lets the limit be known well enough, and tells when none does",
    "[verification][long]") {
  cases::Case definition = block(1e-3, 0);
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.refine = 5;
  cases::Scene finest = cases::make_scene(definition);
  const double truth = shift(finest, solve_fem_as_given(finest));
  definition.fem.refine = 0;
  definition.fem.has_auto_accuracy = true;
  std::size_t last = 1;
  for (const double width : {100., 40., 10.}) {
    definition.expectations[0].interval = {0, width};
    const cases::Scene scene = cases::make_scene(definition);
    const Answers fem = solve_fem(scene, 0);
    CAPTURE(width, fem.choices);
    CHECK(fem.resolved.refine == 0); // the answer is that of the case's own mesh
    CHECK(shift(scene, fem.fem) == shift(scene, solve_fem_as_given(scene)));
    REQUIRE(fem.refined.has_value());
    CHECK(fem.refined->solutions.size() >= last);
    last = fem.refined->solutions.size();
    const MeshStudy study = study_meshes(scene, *fem.refined, 0);
    REQUIRE(study.measures[0].reference.has_value());
    const Limit limit = *study.measures[0].reference;
    CHECK(100 * limit.uncertainty <= width / 4 * std::abs(limit.value));
    CHECK(std::abs(limit.value - truth) <= limit.uncertainty); // 64 elements to an edge are the truth here
  }
  CHECK(last > 2);
  definition.expectations[0].interval = {0, 1e-9};
  const Answers never = solve_fem(cases::make_scene(definition), 0);
  CHECK_THAT(never.choices.back(),
             Catch::Contains("not reached") && Catch::Contains("the next mesh would have"));
}

TEST_CASE("concentrated forces, hard cases and accuracy = none are not refined") {
  cases::Case definition = block(1e-3, 1);
  definition.fem.formulation = cases::Formulation::small_strain;
  CHECK_FALSE(solve_fem(cases::make_scene(definition), 0).refined);
  definition.fem.has_auto_accuracy = true;
  definition.stress = cases::Stress{};
  definition.stress->max_seconds = 100;
  definition.stress->max_iterations = 100;
  CHECK_FALSE(solve_fem(cases::make_scene(definition), 0).refined);
  definition.stress.reset();
  definition.loads[0].kind = cases::loads::NodalForce{{1e-3, 0, 0}};
  const auto refined = solve_fem(cases::make_scene(definition), 0).refined;
  REQUIRE(refined.has_value());
  CHECK(refined->solutions.empty());
  CHECK_THAT(refined->reason, Catch::Contains("no continuum limit"));
}

TEST_CASE("a moved point has no continuum limit, a moved face has one") {
  cases::Case definition = block(0, 1);
  definition.loads.clear();
  cases::Moved moved;
  moved.displacement = {0, 0, 0.1};
  moved.region.name = "z+";
  definition.moved = {moved};
  CHECK_FALSE(reason_without_continuum_limit(cases::make_scene(definition)));
  definition.moved[0].region.name = "z+ x+ y+";
  CHECK_THAT(reason_without_continuum_limit(cases::make_scene(definition)).value_or(""),
             Catch::Contains("moved[0] is of points or edges"));
}

TEST_CASE("a mesh that fails costs the others nothing") {
  cases::Case definition = block(1e-3, 1);
  definition.fem.formulation = cases::Formulation::small_strain;
  const cases::Scene scene = cases::make_scene(definition);
  KeptMeshes kept; // says of the third mesh that it failed
  std::vector<int> solved;
  kept.find = [](const cases::Fem& fem) -> std::optional<Answer> {
    if (fem.refine < 2) return std::nullopt;
    Answer failed;
    failed.solution.status = cases::Status::failed;
    failed.solution.message = "out of luck";
    return failed;
  };
  kept.keep = [&](const cases::Fem& fem, const Answer&) { solved.push_back(fem.refine); };
  const Answers fem = solve_fem(scene, 4, kept);
  REQUIRE(fem.refined.has_value());
  CHECK(fem.refined->refine == std::vector<int>{0, 1});
  CHECK(solved == std::vector<int>{0, 1});
  CHECK(fem.refined->reason == "the mesh refined 2 times was not solved: out of luck");
  const MeshStudy study = study_meshes(scene, *fem.refined, 0);
  REQUIRE(study.measures[0].reference.has_value()); // two meshes: uncertain by three times the last change
  const auto& values = study.measures[0].values;
  CHECK(study.measures[0].reference->value == values[1]);
  CHECK(study.measures[0].reference->uncertainty == 3 * std::abs(values[1] - values[0]));
}

TEST_CASE("meshes that an earlier command has solved are not solved again") {
  cases::Case definition = block(1e-3, 1);
  definition.fem.formulation = cases::Formulation::small_strain;
  const cases::Scene scene = cases::make_scene(definition);
  std::vector<std::pair<int, Answer>> store;
  int n_found = 0;
  KeptMeshes kept;
  kept.find = [&](const cases::Fem& fem) -> std::optional<Answer> {
    for (const auto& [refine, answer] : store)
      if (refine == fem.refine) {
        ++n_found;
        return answer;
      }
    return std::nullopt;
  };
  kept.keep = [&](const cases::Fem& fem, const Answer& answer) {
    if (store.size() < 2) store.emplace_back(fem.refine, answer); // interrupted after two
  };
  const Answers first = solve_fem(scene, 3, kept);
  CHECK(n_found == 0);
  REQUIRE(store.size() == 2);
  const Answers second = solve_fem(scene, 3, kept);
  CHECK(n_found == 2);
  for (std::size_t m = 0; m < 3; ++m)
    CHECK(second.refined->solutions[m].displacement == first.refined->solutions[m].displacement);
}
