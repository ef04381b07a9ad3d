#include "compare/error_bars/convergence.hpp"

#include "compare/error_bars/auto_fem.hpp"
#include "compare/solve/solvers.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

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
  // The order is between the second, that of smooth solutions, and the lower one of the clamped edge.
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
  CHECK(study.measures[0].reference->uncertainty == Approx(2.2e-9)); // what a solve leaves undecided
}

namespace {

MeshLimit limit_of(const std::vector<double>& coarse_to_fine, double ratio = 2) {
  const MeshVerdict verdict = judge_refinement(coarse_to_fine, ratio);
  REQUIRE(std::holds_alternative<MeshLimit>(verdict));
  return std::get<MeshLimit>(verdict);
}

void check_no_limit(const std::vector<double>& coarse_to_fine, const std::string& reason) {
  const MeshVerdict verdict = judge_refinement(coarse_to_fine, 2);
  REQUIRE(std::holds_alternative<std::string>(verdict));
  CHECK_THAT(std::get<std::string>(verdict), Catch::Contains(reason));
}

} // namespace

TEST_CASE("the order, the extrapolated value and the index of a published sequence", "[verification]") {
  const MeshLimit limit = limit_of({0.96178, 0.96854, 0.97050});
  CHECK(limit.order == Approx(1.78618).margin(5e-6));         // the digits given
  CHECK(limit.extrapolated == Approx(0.971300).margin(5e-7)); // the digits given
  CHECK(limit.index_percent == Approx(0.10308).margin(5e-6)); // the digits given
}

TEST_CASE("an error of one power of the mesh width is found exactly", "[verification]") {
  for (const double ratio : {1.5, 2.0, 3.0})
    for (const double p : {0.5, 1.0, 2.0, 4.0})
      for (const double sign : {-1.0, 1.0}) {
        std::vector<double> values;
        for (int mesh = 0; mesh < 4; ++mesh) values.push_back(-7 + sign * 0.3 * std::pow(ratio, -p * mesh));
        const MeshLimit limit = limit_of(values, ratio);
        // differences of values of 7 carry rounding of 1e-15, and the smallest difference here is 3e-6
        CHECK(limit.order == Approx(p).epsilon(1e-8));
        CHECK(limit.extrapolated == Approx(-7).epsilon(1e-10));
        for (const double value : values)
          CHECK(discretisation_error_percent(value, limit) ==
                Approx(125 * std::abs((value + 7) / value)).epsilon(1e-5));
        CHECK(limit.index_percent == discretisation_error_percent(values.back(), limit));
      }
}

TEST_CASE("only the three finest meshes count") {
  CHECK(limit_of({5, 0.96178, 0.96854, 0.97050}).order == limit_of({0.96178, 0.96854, 0.97050}).order);
}

TEST_CASE("a sequence without a visible limit is answered with the reason") {
  check_no_limit({1, 2, 1.5}, "oscillate");
  check_no_limit({-1, -2, -1.5}, "oscillate");
  check_no_limit({1, 2, 4}, "do not draw nearer");
  check_no_limit({1, 2, 3}, "do not draw nearer");
  check_no_limit({1, 1, 2}, "do not draw nearer");
  check_no_limit({1, 2, 2}, "agree");
  check_no_limit({3, 3, 3}, "agree");
  check_no_limit({-4, -2, 0}, "zero");
  check_no_limit({0, 0, 0}, "zero");
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  check_no_limit({1, 2, nan}, "not finite");
  check_no_limit({nan, 2, 3}, "not finite");
  check_no_limit({1, infinity, 3}, "not finite");
}

namespace {

Limit found_limit(const std::vector<double>& coarse_to_fine) {
  const auto found = find_limit(coarse_to_fine);
  REQUIRE(std::holds_alternative<Limit>(found));
  return std::get<Limit>(found);
}

} // namespace

TEST_CASE("a limit that one mesh, or meshes that move apart, cannot show is told so") {
  const auto reason_of = [](const std::vector<double>& values) {
    return std::get<std::string>(find_limit(values));
  };
  CHECK_THAT(reason_of({1}), Catch::Contains("one mesh"));
  CHECK_THAT(reason_of({1, 2, 3.5}), Catch::Contains("do not draw nearer"));
  CHECK_THAT(reason_of({1, 2, 0.5}), Catch::Contains("do not draw nearer"));
  CHECK_THAT(reason_of({1, 2, std::numeric_limits<double>::quiet_NaN()}), Catch::Contains("not finite"));
}

TEST_CASE(
    "two meshes are known to three times their change, values that turn to the larger of the last two") {
  CHECK(found_limit({4, 5}).value == 5);
  CHECK(found_limit({4, 5}).uncertainty == 3);
  CHECK(found_limit({0, 5, 4}).value == 4);
  CHECK(found_limit({0, 5, 4}).uncertainty == 5);
  CHECK(found_limit({0, 5, 4}).note == "the values oscillate");
  CHECK(found_limit({0, 5, 4}).turns);
  // The deflection of a clamped bar of nu = 0.499, whose limit is 0.058200: parts of opposite sign make it
  // turn.
  const Limit turning = found_limit({0.0588625, 0.0580345, 0.0580363});
  CHECK(turning.turns);
  CHECK(std::abs(turning.value - 0.058200) <= turning.uncertainty);
}

TEST_CASE("an order is taken at its word once two steps show it", "[verification]") {
  // 7 + h^p on four meshes: three are extrapolated to the limit, with three times the distance to it
  for (const double p : {0.5, 1.0, 1.5, 2.0}) {
    std::vector<double> values;
    for (int mesh = 0; mesh < 4; ++mesh) values.push_back(7 + std::pow(2., -p * mesh));
    const double left = values[3] - 7;
    CHECK(found_limit(values).value == Approx(7).epsilon(1e-12));
    CHECK(found_limit(values).uncertainty == Approx(1.25 * left).epsilon(1e-9));
    CHECK(found_limit(values).note.empty());
    values.erase(values.begin());
    CHECK(found_limit(values).uncertainty == Approx(3 * left).epsilon(1e-9));
    CHECK_FALSE(found_limit(values).note.empty());
  }
  // an accident: the last change is a hundredth of the one before, which no element's order explains
  CHECK(found_limit({0, 1, 1.01}).value == 1.01);
  CHECK(found_limit({0, 1, 1.01}).uncertainty == 1);
  CHECK(found_limit({0, 1, 1.01}).turns);
  CHECK_FALSE(found_limit({0, 1, 1.21}).turns);                      // an order of 2.25
  CHECK_FALSE(std::get<Limit>(find_limit({0, 1, 1.1}, 2, 4)).turns); // 3.3, of quadratic elements
  CHECK(std::get<Limit>(find_limit({0, 1, 1.1}, 2, 4)).value == Approx(1.1 + 0.1 / 3)); // counts as 2
}

TEST_CASE("a field has the limit of its values", "[verification]") {
  using Vectors = std::vector<Eigen::Vector3d>;
  const auto norm = [](const Vectors& field) { return std::hypot(field[0].norm(), field[1].norm()); };
  std::vector<Vectors> fields;
  for (int mesh = 0; mesh < 4; ++mesh) {
    const double h = std::pow(2., -1.5 * mesh);
    fields.push_back({{1 + h, 2, 0}, {0, 3 - 2 * h, 5 + h}});
  }
  const auto found = find_limit({&fields[0], &fields[1], &fields[2], &fields[3]}, norm);
  REQUIRE(std::holds_alternative<FieldLimit>(found));
  const auto& limit = std::get<FieldLimit>(found);
  CHECK((limit.value[0] - Eigen::Vector3d(1, 2, 0)).norm() < 1e-12);
  CHECK((limit.value[1] - Eigen::Vector3d(0, 3, 5)).norm() < 1e-12);
  const double left = std::pow(2., -4.5) * std::sqrt(6.);
  CHECK(norm(limit.uncertainty) == Approx(1.25 * left));
  CHECK(norm(std::get<FieldLimit>(find_limit({&fields[2], &fields[3]}, norm)).uncertainty) ==
        Approx(3 * (std::pow(2., 1.5) - 1) * left));
  CHECK(std::holds_alternative<std::string>(find_limit({&fields[3], &fields[2], &fields[0]}, norm)));
}
