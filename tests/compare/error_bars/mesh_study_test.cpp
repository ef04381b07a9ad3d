#include "compare/error_bars/mesh_study.hpp"

#include "compare/error_bars/auto_fem.hpp"
#include "compare/solve/solvers.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace compare;
using namespace cases::loads;

namespace {

/// A block on rollers that keep it from moving, pulled at its top by a load.
cases::Case block(const cases::Load& load) {
  cases::Case definition;
  definition.name = "block";
  definition.body = cases::Box{{2, 2, 2}, {2, 2, 2}};
  definition.material = cases::LinearElastic{1, 0.3};
  definition.fixed.push_back({{"x-", std::nullopt, {}}, {true, false, false}});
  definition.fixed.push_back({{"y-", std::nullopt, {}}, {false, true, false}});
  definition.fixed.push_back({{"z-", std::nullopt, {}}, {false, false, true}});
  definition.loads.push_back(load);
  definition.fem.formulation = cases::Formulation::small_strain;
  definition.fem.element = cases::Element::q1;
  definition.measures.push_back({"height", cases::measures::Coordinate{{"z+ x+ y+"}}});
  return definition;
}

std::optional<std::string> reason_for(const cases::Load& applied) {
  return reason_without_continuum_limit(cases::make_scene(block(applied)));
}

MeshStudy study_on_three(const cases::Scene& scene) {
  return study_meshes(scene, solve_fem(scene, 3).refined.value(), scene.definition.fem.refine);
}

} // namespace

TEST_CASE("forces on nodes and edges have no continuum limit, forces over an area have one") {
  CHECK(reason_for({{"z+"}, NodalForce{{0, 0, 0.1}}}).has_value());
  CHECK(reason_for({{"z+ x+ y+"}, TotalForce{{0, 0, 0.1}}}).has_value());
  CHECK(reason_for({{"z+ x+"}, TotalForce{{0, 0, 0.1}}}).has_value());
  CHECK_FALSE(reason_for({{"z+"}, TotalForce{{0, 0, 0.1}}}).has_value());
  CHECK_FALSE(reason_for({{"z+"}, Traction{{0, 0, 0.1}}}).has_value());
  CHECK_FALSE(reason_for({{"z+"}, NodalForce{}}).has_value());
}

TEST_CASE("a study of concentrated forces solves nothing and says why") {
  const MeshStudy study = study_on_three(cases::make_scene(block({{"z+ x+"}, TotalForce{{0, 0, 0.1}}})));
  REQUIRE(study.measures.size() == 1);
  CHECK(study.refine.empty());
  CHECK(study.measures[0].values.empty());
  CHECK_FALSE(study.measures[0].discretisation_error_percent.has_value());
  CHECK_THAT(study.measures[0].reason, Catch::Contains("no continuum limit"));
}

TEST_CASE("the error bar of a clamped block covers what the next finer mesh answers", "[verification]") {
  cases::Case definition = block({{"z+"}, Traction{{0.1, 0, 0}}});
  definition.fixed = {{{"z-", std::nullopt, {}}, {true, true, true}}};
  const cases::Region middle{"", Eigen::Vector3d(1, 1, 2)};
  definition.measures[0].kind = cases::measures::Displacement{middle, cases::Component::x};
  definition.fem.refine = 1;
  const cases::Scene scene = cases::make_scene(definition);
  const cases::Solution own = compare::make_finite_elements(scene)->solve();

  const MeshStudy study = study_on_three(scene);
  CHECK(study.refine == std::vector<int>{0, 1, 2});
  const StudiedMeasure& measure = study.measures.at(0);
  REQUIRE(measure.limit.has_value());
  const int node = cases::select_node(scene.mesh, middle);
  const auto x_at = [&](const cases::Solution& solution) {
    return solution.displacement[static_cast<std::size_t>(node)].x();
  };
  CHECK(measure.values[1] == x_at(own)); // it was not solved again
  CHECK(*measure.discretisation_error_percent ==
        discretisation_error_percent(x_at(own), *measure.limit)); // the case's mesh is the middle one
  // Between second order, where the solution is smooth, and the weakness of the clamped edge's singularity.
  CHECK(measure.limit->order > 1);
  CHECK(measure.limit->order < 2.5);

  definition.fem.refine = 3;
  const double finer = x_at(compare::make_finite_elements(cases::make_scene(definition))->solve());
  CHECK(100 * std::abs(finer - measure.values[2]) <=
        measure.limit->index_percent * std::abs(measure.values[2]));
  CHECK(std::abs(finer - measure.limit->extrapolated) < std::abs(finer - measure.values[2]));
}

TEST_CASE("a stretch that every mesh has exactly leaves nothing to extrapolate", "[verification]") {
  const cases::Scene scene = cases::make_scene(block({{"z+"}, Traction{{0, 0, 0.1}}}));
  const MeshStudy study = study_on_three(scene);
  CHECK(study.measures.at(0).values.size() == 3);
  CHECK(study.measures.at(0).values[0] == Approx(2.2)); // 2 mm at 0.1 MPa and E = 1 MPa
  CHECK_FALSE(study.measures.at(0).limit.has_value());
  CHECK_THAT(study.measures.at(0).reason, Catch::Contains("agree"));
  REQUIRE(study.measures.at(0).reference.has_value()); // which is what all of them say
  CHECK(study.measures[0].reference->value == study.measures[0].values[2]);
  CHECK(study.measures[0].reference->uncertainty == Approx(2.2e-9)); // to what a solve leaves undecided
}
