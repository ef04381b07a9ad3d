#include "compare/cube/cube_benchmark.hpp"

#include "compare/cube/write_design.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/screen.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

TEST_CASE("a cube of another material has the declared formulation, and loads that grow with E L0²") {
  for (const compare::CubeTest& test : compare::cube_tests) {
    CAPTURE(test.test, test.load_set);
    const cases::Case thesis = compare::cube_case(test, cases::LinearElastic{0.3, 0.35}, 1);
    const cases::Case other = compare::cube_case(test, cases::LinearElastic{0.6, 0.45}, 3);
    CHECK(thesis.fem.formulation == cases::Formulation::log_strain);
    CHECK(thesis.fem.element == cases::Element::q1_bbar);
    CHECK(std::get<cases::Box>(other.body).size == Eigen::Vector3d(30, 30, 30));
    REQUIRE(other.loads.size() == thesis.loads.size());
    const auto force = [](const cases::Load& load) {
      return std::get<cases::loads::NodalForce>(load.kind).value;
    };
    for (std::size_t l = 0; l < thesis.loads.size(); ++l)
      CHECK((force(other.loads[l]) - 18 * force(thesis.loads[l])).norm() <=
            1e-15);                          // rounding of forces below 1 N
    CHECK_NOTHROW(cases::make_scene(other)); // the measures find their nodes
  }
}

namespace {

/// A test of one cell's case: L_1 and the volume, both off by what the springs' values say.
compare::Comparison test_with(double height, double volume, cases::Status status) {
  compare::Comparison test;
  test.scene.definition.name = "cube";
  test.scene.definition.measures.resize(2);
  test.scene.definition.measures[0].name = "L_1";
  test.scene.definition.measures[1].name = "volume";
  test.scene.definition.measures[1].kind = cases::measures::Volume{};
  test.measures = {{"L_1", "mm", 100.0, height, std::nullopt},
                   {"volume", "mm3", 100.0, volume, std::nullopt}};
  if (status == cases::Status::converged)
    for (compare::MeasuredValue& measured : test.measures)
      measured.error_same_mesh_percent = *measured.msm - *measured.fem;
  test.answers.fem.solution.status = test.answers.msm.solution.status = status;
  test.answers.msm.solution.outcome = cases::Outcome::stable_equilibrium;
  return test;
}

} // namespace

TEST_CASE("the worst error of a load set is an absolute one, the mean leaves the volume apart") {
  std::vector<compare::Comparison> tests(6, test_with(101, 100, cases::Status::converged));
  tests[1] = test_with(96, 107, cases::Status::converged);
  const compare::CubeErrors errors = compare::cube_errors(tests);
  CHECK(*errors.small.worst == Approx(4));
  CHECK(*errors.small.mean == Approx(2));
  CHECK(*errors.small.worst_volume == Approx(7));
  CHECK(errors.small.worst_test == 1);
  CHECK(*errors.large.worst == Approx(1));
  CHECK(*errors.worst() == Approx(4));
}

TEST_CASE("a load set with a failed test has no errors, but says why") {
  std::vector<compare::Comparison> tests(6, test_with(101, 100, cases::Status::converged));
  tests[4] = test_with(101, 100, cases::Status::failed);
  tests[4].answers.fem.solution.message = "no equilibrium";
  const compare::CubeErrors errors = compare::cube_errors(tests);
  CHECK(errors.small.worst);
  CHECK_FALSE(errors.large.worst);
  CHECK_FALSE(errors.large.is_stable);
  CHECK(errors.large.failure == "large shear: finite elements: no equilibrium");
  CHECK_FALSE(errors.worst());
}

TEST_CASE("an inverted cell or an equilibrium that is not stable makes a load set unstable") {
  std::vector<compare::Comparison> tests(6, test_with(101, 100, cases::Status::converged));
  CHECK(compare::cube_errors(tests).small.is_stable);
  tests[0].answers.msm.solution.inverted_cells = 1;
  tests[3].answers.msm.solution.outcome = cases::Outcome::unstable_equilibrium;
  CHECK_FALSE(compare::cube_errors(tests).small.is_stable);
  CHECK_FALSE(compare::cube_errors(tests).large.is_stable);
}

namespace {

compare::DesignAttempt measured(double error_percent, double compression) {
  compare::DesignAttempt attempt;
  attempt.stability = msm::StabilityRange{3, compression, 2};
  attempt.cube.emplace();
  attempt.cube->small.worst = error_percent;
  attempt.cube->large.worst = error_percent / 2;
  return attempt;
}

} // namespace

TEST_CASE("a design that another beats in accuracy and stability is not on the Pareto front") {
  const std::vector<compare::DesignAttempt> attempts = {measured(5, 0.7), measured(8, 0.6), measured(6, 0.8)};
  const std::vector<bool> front = compare::on_pareto_front(attempts);
  CHECK(front == std::vector<bool>{true, true, false});
}

TEST_CASE("a design that failed a test or was not measured is on no front") {
  compare::DesignAttempt failed = measured(1, 0.3);
  failed.cube->large.worst.reset();
  CHECK_FALSE(failed.cube->worst());
  const compare::DesignAttempt unmeasured;
  CHECK(compare::on_pareto_front({failed, measured(5, 0.7), unmeasured}) ==
        std::vector<bool>{false, true, false});
}

TEST_CASE("the stable strain is the smaller of the two directions'") {
  CHECK(compare::stable_strain({std::exp(0.5), std::exp(-0.2), 1}) ==
        Approx(0.2).epsilon(1e-14)); // exp and log
  CHECK(compare::stable_strain({std::exp(0.1), std::exp(-0.2), 1}) == Approx(0.1).epsilon(1e-14));
}

namespace {

/// Largest error of a test's lengths and angles with springs of one stiffness, with its sign, percent.
double largest_error(const compare::CubeErrors& errors, const std::string& test) {
  double largest = 0;
  for (const compare::CubeError& measured : errors.small.measures) {
    const bool is_volume = measured.measure.find("volume") != std::string::npos;
    if (measured.test.find(test) == std::string::npos || is_volume) continue;
    REQUIRE(measured.error_percent);
    if (std::abs(*measured.error_percent) > std::abs(largest)) largest = *measured.error_percent;
  }
  return largest;
}

} // namespace

TEST_CASE("springs of one stiffness err on the cube as Vega's MassSpringSystem does, and none is right",
          "[peer][verification][long]") {
  // Measured with Vega's own class from cubes, E = 0.3 MPa, nu = 0.35, cells of 1 mm, small loads.
  struct Row {
    double stiffness, tension, shear, torsion; // N/m, percent
  };
  const double tolerance = 1.0; // points: the printed digits, and a reference of another program
  for (const Row& row : {Row{45, 3.8, 38, -18}, Row{55, 2.5, 12.9, -33}, Row{65, 1.6, -4.7, -43}}) {
    CAPTURE(row.stiffness);
    cases::Msm options;
    options.design = cases::Design::uniform;
    options.uniform_stiffness = row.stiffness;
    const msm::DesignRequest request =
        compare::design_request(cases::LinearElastic{0.3, 0.35}, msm::cube(1), options);
    std::vector<compare::DesignAttempt> attempts{compare::attempt_one(request)};
    compare::measure_on_cube(attempts, request);
    const compare::CubeErrors& errors = *attempts.front().cube;
    CHECK(largest_error(errors, "tensile") == Approx(row.tension).margin(tolerance));
    CHECK(largest_error(errors, "shear") == Approx(row.shear).margin(tolerance));
    CHECK(largest_error(errors, "torsion") == Approx(row.torsion).margin(tolerance));
  }
}

TEST_CASE(
    "designs of cells of terms are solved on the cube as they are designed, mirrored from cell to cell") {
  cases::Case definition = compare::cube_case(compare::cube_tests[0], cases::LinearElastic{0.3, 0.35}, 1);
  definition.msm = cases::Msm{};
  definition.msm.design = cases::Design::van_gelder;
  const cases::Scene scene = cases::make_scene(definition);
  const msm::DesignResult design = compare::design_for(scene);
  REQUIRE(design.springs.terms());
  const std::vector<int>& kinds = design.springs.terms()->kind_of_cell;
  REQUIRE(kinds.size() == 1000);
  CHECK(kinds[0] == 0);
  CHECK(kinds[1] == 1);  // the next along x
  CHECK(kinds[10] == 1); // the next along y
  CHECK(kinds[11] == 0);
  CHECK(kinds[100] == 1); // the next along z
  CHECK(compare::is_assembled(scene));
  cases::Scene no_grid = scene;
  no_grid.mesh.grid.reset();
  CHECK_THROWS_WITH(compare::design_for(no_grid), Catch::Contains("grids of equal cells"));
}

using Catch::Contains;
using compare::DesignAttempt;

namespace {

/// A design that was measured: errors of alpha_1 under small and large loads, percent.
DesignAttempt attempted(const std::string& name, double small, double large, bool is_stable,
                        double compression) {
  DesignAttempt attempt{name, msm::DesignResult{}};
  attempt.stability = msm::StabilityRange{3, compression, 1};
  const auto errors = [](const std::string& test, double error, bool stable) {
    return compare::LoadSetErrors{error, error, 0.5, stable, {{test, "alpha_1", -error, ""}}};
  };
  attempt.cube = compare::CubeErrors{errors("small", small, true), errors("large", large, is_stable)};
  return attempt;
}

DesignAttempt refusing(const std::string& name) {
  return {name, std::nullopt, "it refuses " + std::string(60, 'x') + " " + std::string(60, 'y')};
}

msm::DesignRequest request_of(double poissons_ratio) {
  return compare::design_request(cases::LinearElastic{0.3, poissons_ratio}, msm::cube(1), cases::Msm{});
}

} // namespace

TEST_CASE("the stable design with the smallest worst error is recommended, with its error, place and rival") {
  const std::string text = compare::recommendation_text(
      {attempted("moduli", 2, 9, true, 0.8), refusing("baudet"), attempted("matched", 1, 2.5, true, 0.7),
       attempted("uniform", 0.1, 0.2, false, 0.8)},
      request_of(0.3));
  CHECK_THAT(text, Catch::StartsWith("Use matched for E = 0.3 MPa and nu = 0.3:"));
  CHECK_THAT(text, Contains("2.50 % (alpha_1 under large loads)"));
  CHECK_THAT(text, Contains("the 2 designs that are stable in every test; the next is moduli with 9.00 %"));
  CHECK_THAT(text, Contains("that names no design takes it too. A case without them takes midline"));
}

TEST_CASE(
    "another design that a case takes without a name is told with its error, and with what speaks for it") {
  const std::vector<DesignAttempt> attempts{attempted("hybrid", 3, 12, true, 0.5),
                                            attempted("matched", 1, 2, true, 0.8)};
  CHECK_THAT(compare::recommendation_text(attempts, request_of(0.45)),
             Contains("Use matched") && Contains("that names no design takes hybrid, with 12.00 %") &&
                 Contains("stable to logarithmic strains of 0.69, that of matched to 0.22"));
  CHECK_THAT(compare::recommendation_text({attempts[1]}, request_of(0.45)),
             Contains("that names no design takes hybrid."));
}

TEST_CASE("without a stable design none is recommended") {
  CHECK(compare::recommended({attempted("hybrid", 1, 1, false, 0.5), refusing("baudet")}) == nullptr);
  CHECK_THAT(compare::recommendation_text({attempted("hybrid", 1, 1, false, 0.5)}, request_of(0.45)),
             Catch::StartsWith("None is recommended"));
}

TEST_CASE(
    "the comparison of designs stands in 100 characters, refusals and warnings too, and shouts nowhere") {
  std::vector<DesignAttempt> attempts{attempted("nonlinear_method", 123.4, 1234.5, false, 0.8),
                                      refusing("baudet")};
  attempts[0].design->warnings = {"the lattice " + std::string(40, 'y') + " " + std::string(60, 'z')};
  attempts[0].design->stiffness.exponents = msm::Exponents{-12.345, 1.2345, 1.2345};
  attempts[0].cube->large.failure = "large shear: springs: no equilibrium " + std::string(100, '.');
  std::ostringstream out;
  write_comparison_text(out, attempts);
  INFO(out.str());
  CHECK(width_of_text(out.str()) <= 100);
  CHECK_THAT(out.str(), Contains("refused: it refuses") && Contains("springs: no equilibrium..."));
  CHECK_FALSE(has_shouting(out.str(), {}));
}
