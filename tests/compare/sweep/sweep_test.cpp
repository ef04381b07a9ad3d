#include "compare/sweep/sweep.hpp"

#include "cases/case/read_case.hpp"
#include "compare/solve/process_pool.hpp"
#include "compare/solve/solvers.hpp"
#include "compare/sweep/write_sweep.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>

using namespace springproof;

using namespace compare;
using Catch::Contains;

namespace {

const std::string sweep_cases = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/sweep/";

/// A cube of two cells to a side, so that the levels are 1, 2 and 4.
cases::Case tiny() {
  cases::Case definition = cases::read_case(sweep_cases + "cube_tensile.toml");
  std::get<cases::Box>(definition.body).cells = {2, 2, 2};
  return definition;
}

Variant spring_variant(int cells, double tolerance = 1e-9) {
  return {Program::springs, cases::Design::moduli, {}, {}, {cells, cells, cells}, tolerance};
}

SweepRow measured(const Variant& variant, double seconds, double error) {
  SweepRow row{variant, {}, error, {}};
  row.run.first.status = cases::Status::converged;
  row.run.setup_seconds = {1, 1, 1};
  row.run.first_seconds = {seconds, seconds, 100};        // a median is not moved by one slow round
  row.measure_error_percent = {-2 * error, std::nullopt}; // the case's two measures
  return row;
}

SweepRow failed(const Variant& variant) {
  SweepRow row{variant, {}, std::nullopt, {}};
  row.run.first.status = cases::Status::failed;
  row.run.first.message = "equilibrium lost, they say";
  return row;
}

Sweep synthetic() {
  Sweep sweep;
  sweep.definition = tiny();
  sweep.plan.levels = {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}};
  sweep.plan.reference = plan_sweep(sweep.definition, Extent::quick).reference;
  sweep.rows = {measured(spring_variant(1), 2, 9), measured(spring_variant(2, 1e-2), 3, 8),
                measured(spring_variant(2), 4, 7), failed(spring_variant(4))};
  sweep.reason_without_reference = "none was asked for";
  return sweep;
}

} // namespace

TEST_CASE("every plan has the designs, both strains and the elements, and says what it leaves out") {
  const Plan full = plan_sweep(cases::read_case(sweep_cases + "cube_shear.toml"), Extent::full);
  CHECK(full.levels == std::vector<std::array<int, 3>>{{3, 3, 3}, {6, 6, 6}, {12, 12, 12}, {24, 24, 24}});
  const auto count = [&](const std::string& method) {
    return std::count_if(full.variants.begin(), full.variants.end(),
                         [&](const Variant& v) { return method_name(v) == method; });
  };
  for (const char* design :
       {"linear_method", "nonlinear_method", "moduli", "hybrid", "matched", "multi_load"})
    CHECK(count(std::string("springs ") + design) == 4 * 3); // levels, tolerances
  for (const char* method : {"small_strain q1", "small_strain q1_bbar", "small_strain q1_wilson",
                             "small_strain q2", "log_strain q1", "log_strain q1_bbar", "log_strain q1_wilson",
                             "log_strain q2", "CalculiX small_strain q1"})
    CHECK(count(method) >= 2);
  REQUIRE(full.reference.size() == 3);
  for (std::size_t r = 0; r < full.reference.size(); ++r)
    CHECK(full_name(full.variants[r]) == full_name(full.reference[r]));
  for (std::size_t a = 0; a < full.variants.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) CHECK(full_name(full.variants[a]) != full_name(full.variants[b]));
  CHECK_FALSE(full.left_out.empty());
  for (const LeftOut& left : full.left_out) CHECK_FALSE(left.reason.empty());
}

TEST_CASE("a box of odd cells is swept from its own mesh on") {
  cases::Case definition = tiny();
  std::get<cases::Box>(definition.body).cells = {3, 2, 2};
  CHECK(plan_sweep(definition, Extent::quick).levels.front() == std::array<int, 3>{3, 2, 2});
}

TEST_CASE("a body that is no box, or a material without small strain, is refused") {
  cases::Case mesh = tiny(), ogden = tiny();
  mesh.body = cases::MeshFile{"body.msh", {}};
  ogden.material = cases::Ogden{{0.1}, {2}, std::nullopt};
  CHECK_THROWS_WITH(plan_sweep(mesh, Extent::full), Contains("body.shape") && Contains("run --converge"));
  CHECK_THROWS_AS(plan_sweep(ogden, Extent::full), cases::InputError);
  cases::Case power_log = tiny();
  power_log.msm.law = cases::SpringLaw::power_log;
  power_log.msm.exponent = {-1, -1, -1};
  CHECK_THROWS_WITH(plan_sweep(power_log, Extent::full), Contains("msm.law") && Contains("must be left out"));
}

TEST_CASE("forces on points have no limit to be measured against, and are refused") {
  cases::Case definition = tiny();
  definition.loads[0].kind = cases::loads::NodalForce{{0, 0, 1e-3}};
  CHECK_THROWS_WITH(make_sweep(definition, Extent::quick, {}), Contains("no continuum limit"));
}

TEST_CASE("a budget leaves out the variants of the longest estimated times, never the reference's meshes") {
  const cases::Case definition = cases::read_case(sweep_cases + "cube_shear.toml");
  const Sweep whole = make_sweep(definition, Extent::full, {});
  const auto sum = [](const Sweep& sweep) {
    const std::vector<double> seconds = estimated_seconds(sweep);
    return std::accumulate(seconds.begin(), seconds.end(), 0.);
  };
  const double budget = sum(whole) / 2;
  const Sweep cut = make_sweep(definition, Extent::full, {}, budget);
  CHECK(sum(cut) <= budget);
  REQUIRE(cut.plan.variants.size() < whole.plan.variants.size());
  const std::size_t n_cut = whole.plan.variants.size() - cut.plan.variants.size();
  REQUIRE(cut.plan.left_out.size() == whole.plan.left_out.size() + n_cut);
  CHECK_THAT(cut.plan.left_out.back().reason, Contains("budget of"));
  const auto longest_kept = [&] {
    const std::vector<double> seconds = estimated_seconds(cut);
    return *std::max_element(seconds.begin() + static_cast<long>(cut.plan.reference.size()), seconds.end());
  };
  std::size_t n_longer = 0; // variants of the whole plan longer than the longest one kept
  for (const Variant& variant : whole.plan.variants)
    n_longer += estimate_of(whole, variant).seconds > longest_kept();
  CHECK(n_longer <= n_cut + cut.plan.reference.size());
  const Sweep least = make_sweep(definition, Extent::full, {}, 1e-9);
  REQUIRE(least.plan.variants.size() == least.plan.reference.size());
  for (std::size_t mesh = 0; mesh < least.plan.reference.size(); ++mesh)
    CHECK(full_name(least.plan.variants[mesh]) == full_name(least.plan.reference[mesh]));
  CHECK(make_sweep(definition, Extent::full, {}, 1e9).plan.variants.size() == whole.plan.variants.size());
}

TEST_CASE(
    "the written plan has every method with its number of variants, and what is left out with the reason") {
  const Sweep sweep = make_sweep(cases::read_case(sweep_cases + "cube_shear.toml"), Extent::full, {}, 30);
  std::ostringstream text;
  write_plan(text, sweep);
  for (const Variant& variant : sweep.plan.variants) CHECK_THAT(text.str(), Contains(method_name(variant)));
  CHECK_THAT(text.str(), Contains(std::to_string(sweep.plan.variants.size()) + " variants, about "));
  for (const LeftOut& left : sweep.plan.left_out)
    CHECK_THAT(text.str(), Contains("left out: " + left.what + ": " + left.reason));
}

TEST_CASE("repetitions are as many as the budget pays for") {
  const TimingRules rules{5, 2};
  CHECK(n_repetitions(0.001, rules) == 5);
  CHECK(n_repetitions(0.4, rules) == 5);
  CHECK(n_repetitions(0.7, rules) == 2);
  CHECK(n_repetitions(2, rules) == 1);
  CHECK(n_repetitions(2.1, rules) == 0); // the first round has to stand for all
  CHECK(n_repetitions(std::nan(""), rules) == 0);
}

TEST_CASE("a timing's answer that is not whole is refused") {
  const Variant variant = spring_variant(1);
  CHECK_THROWS_AS(variant_run_from("1 2 three", variant), std::exception);
  VariantRun run;
  run.first.status = cases::Status::converged;
  run.first.displacement.resize(8, Eigen::Vector3d::Zero());
  CHECK(variant_run_from(bytes_of(run), variant).first.displacement.size() == 8);
  CHECK_THROWS_AS(variant_run_from(bytes_of(run), spring_variant(2)), std::exception);
  run.first.displacement[7].x() = std::nan("");
  CHECK_THROWS_AS(variant_run_from(bytes_of(run), variant), std::exception);
}

TEST_CASE("failed variants and missing values give no points") {
  const Sweep sweep = synthetic();
  const auto points = points_of(sweep, Error::field, Clock::first_answer);
  REQUIRE(points.size() == 3);
  CHECK(points[0].seconds == 3); // setup and solve
  CHECK(points_of(sweep, Error::field, Clock::re_solve).empty());
  CHECK(points_of(sweep, Error::worst_measure, Clock::first_answer)[0].error_percent ==
        18); // its sign is dropped
  CHECK_FALSE(worst_measure_error(failed(spring_variant(4))));
}

TEST_CASE("points whose error is less than more cells leave of it are told apart") {
  Sweep sweep = synthetic();
  sweep.rows.back() = measured(spring_variant(4), 5, 8.5); // the points before have 9, 8 and 7
  const auto points = points_of(sweep, Error::field, Clock::first_answer);
  REQUIRE(points.size() == 4);
  for (const Point& point : points)
    CHECK(point.more_cells_percent ==
          (point.error_percent == 7 ? std::optional<double>(8.5) : std::nullopt)); // 8 is within a tenth
}

TEST_CASE("the errors of a design by level are those of its tightest tolerance") {
  const auto errors = errors_by_level(synthetic(), "springs moduli", Error::field);
  CHECK(errors == std::vector<std::optional<double>>{9., 7., std::nullopt});
}

TEST_CASE("a failed variant is a row with its reason in the text, the CSV and the JSON") {
  const Sweep sweep = synthetic();
  std::ostringstream text, csv;
  write_sweep_text(text, sweep);
  write_sweep_csv(csv, sweep);
  CHECK_THAT(text.str(), Contains("failed: equilibrium lost") && Contains("nothing can be concluded"));
  CHECK_THAT(csv.str(), Contains("failed,\"equilibrium lost, they say\""));
  std::istringstream lines(csv.str());
  std::vector<std::string> all;
  for (std::string line; std::getline(lines, line);) all.push_back(line);
  REQUIRE(all.size() == 5);
  const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
  CHECK(commas(all[1]) == commas(all[0]));
  CHECK(commas(all[4]) == commas(all[0]) + 1); // one inside the quotes
  const auto document = sweep_to_json(sweep);
  CHECK(document["variants"][3]["message"] == "equilibrium lost, they say");
  CHECK(document["variants"][3]["error_percent"]["field"].is_null());
}

TEST_CASE(
    "a worker times a variant: every round has its setup, solve and re-solve, and the process its memory") {
  const TimingRules rules{2, 1e9}; // however slow the machine is
  const Variant elements{Program::finite_elements, {},        cases::Formulation::log_strain,
                         cases::Element::q2,       {2, 2, 2}, 1e-9};
  for (const Variant& variant : {spring_variant(2), elements}) {
    const std::string job = timing_job(cases::read_case(sweep_cases + "cube_tensile.toml"), variant, rules);
    const JobAnswer answer =
        run_in_processes(
            {SPRINGPROOF_PROGRAM, "worker", "--timing"}, 1, 1, [&](std::size_t) { return job; },
            [](std::size_t, const compare::JobAnswer&) {})
            .front();
    INFO(answer.reason);
    REQUIRE(answer.bytes);
    const VariantRun run = variant_run_from(*answer.bytes, variant);
    REQUIRE(run.first.status == cases::Status::converged);
    CHECK(run.is_warm);
    CHECK(run.setup_seconds.size() == 2);
    CHECK(run.first_seconds.size() == 2);
    CHECK(run.again_seconds.size() == 2);
    const auto cells = field_cells(variant); // twice its own cells for quadratic elements
    CHECK(run.first.displacement.size() == static_cast<std::size_t>(std::pow(cells[0] + 1, 3)));
    CHECK(run.first.newton_iterations >= run.again.newton_iterations); // it starts nearer
    CHECK(run.again.newton_iterations >= 1);
    CHECK(run.first.force_evaluations > run.first.newton_iterations);
    CHECK(run.first.factorisations > 0); // so small a lattice is factorised too
    CHECK(run.peak_megabytes.value() >= run.start_megabytes.value());
  }
}

TEST_CASE("a q2 model's field has its own nodes in their places") {
  const Variant variant{Program::finite_elements, {},        cases::Formulation::small_strain,
                        cases::Element::q2,       {1, 2, 3}, 1e-9};
  const VariantRun run = time_variant(tiny(), variant, {1, 1e9});
  const auto fine = field_cells(variant);
  // The vertices' displacements are those that the model gives for its mesh; the clamped face is at rest.
  const cases::Solution vertices =
      compare::make_finite_elements(cases::make_scene(with_variant(tiny(), variant)))->solve();
  const auto at_vertices = interpolate(run.first.displacement, fine, variant.cells);
  REQUIRE(at_vertices.size() == vertices.displacement.size());
  for (std::size_t n = 0; n < at_vertices.size(); ++n)
    CHECK((at_vertices[n] - vertices.displacement[n]).norm() <= 1e-9); // mm, both solved to 1e-9
  for (int n = 0; n < (fine[0] + 1) * (fine[1] + 1); ++n)
    CHECK(run.first.displacement[static_cast<std::size_t>(n)].norm() == 0);
  CHECK(run.first.displacement.back().z() > 0.1); // pulled
}

TEST_CASE("the total of a callgrind file is found, and its absence is an error") {
  std::istringstream whole("events: Ir\nfn=(1)\n1 5\ntotals: 1234567\n"), broken("events: Ir\n");
  CHECK(callgrind_total(whole) == 1234567);
  CHECK_THROWS_AS(callgrind_total(broken), std::runtime_error);
}
