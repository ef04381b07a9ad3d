#include "compare/sweep/write_sweep.hpp"

#include "cases/case/error.hpp"
#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "msm/design/design.hpp"
#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using Catch::Contains;
using compare::Sweep;
using compare::SweepRow;

namespace motion_sweeps {

namespace {

cases::Case block(const std::string& node = "x+ y+ z+") {
  return cases::read_case_text(R"(
schema = 1
name = "block"
[body]
shape = "box"
size = [10, 10, 20]
cells = [2, 2, 4]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
mass_damping = 20
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [9.81, 0, 0]
[dynamics]
scheme = "newmark"
step = 0.005
end = 0.06
[[measure]]
name = "tip"
kind = "displacement"
node = ")" + node + R"("
component = "x"
[fem]
formulation = "log_strain"
element = "q1_bbar"
[msm]
design = "hybrid"
)",
                               "block.toml");
}

cases::Trajectory motion(const std::vector<double>& times, double factor) {
  cases::Trajectory result;
  result.nodes = {3};
  for (const double time : times) {
    result.time.push_back(time);
    result.displacement.emplace_back(factor * time, 0, 0);
  }
  return result;
}

SweepRow springs(double step, double seconds, std::optional<double> error, int n_cells = 2) {
  SweepRow row;
  row.variant.design = cases::Design::hybrid;
  row.variant.cells = {n_cells, n_cells, n_cells};
  row.variant.step = step;
  row.run.first.status = error ? cases::Status::converged : cases::Status::failed;
  if (error) row.run.first_seconds = {seconds};
  row.field_error_percent = error;
  return row;
}

SweepRow elements(double step, double seconds, std::optional<double> error, int n_cells = 2) {
  SweepRow row = springs(step, seconds, error, n_cells);
  row.variant.program = compare::Program::finite_elements;
  row.variant.formulation = cases::Formulation::log_strain;
  row.variant.element = cases::Element::q1;
  return row;
}

Sweep swept(const std::vector<SweepRow>& rows, double uncertainty = 0.5) {
  Sweep sweep;
  sweep.definition.dynamics.emplace();
  sweep.reference.emplace().field.uncertainty_percent = uncertainty;
  sweep.rows = rows;
  return sweep;
}

Sweep quickly(const cases::Case& definition) {
  return compare::sweep_motion(definition, compare::Extent::quick, [](const Sweep&) {});
}

std::vector<const SweepRow*> rows_of(const Sweep& sweep, const std::string& method) {
  std::vector<const SweepRow*> rows;
  for (const SweepRow& row : sweep.rows)
    if (method_name(row.variant) == method) rows.push_back(&row);
  return rows;
}

} // namespace

TEST_CASE("the difference of two motions is of the times that both have") {
  const auto fine = motion({0, 0.5, 1, 1.5, 2}, 1), coarse = motion({0, 1, 2}, 1.1);
  CHECK(compare::motion_error_percent(fine, coarse).value() == Approx(10));
  CHECK(compare::motion_error_percent(fine, fine).value() == 0);
  CHECK_FALSE(compare::motion_error_percent(motion({0, 1}, 0), coarse)); // nothing moves
  CHECK(std::isnan(compare::motion_error_percent(fine, motion({0, 1}, std::nan(""))).value()));
}

TEST_CASE("the most accurate motion at a rate keeps up with it") {
  const Sweep sweep = swept({springs(0.02, 0.1, 2), springs(0.01, 0.5, 5), springs(0.01, 0.9, 3),
                             springs(0.005, 1.1, 1.5), springs(0.01, 0.2, std::nullopt)});
  CHECK_THAT(compare::interactive_sentence(sweep, 60), Contains("error 3 %, 0.9 s"));
  CHECK_THAT(compare::interactive_sentence(sweep, 30), Contains("error 2 %"));
  CHECK(compare::interactive_sentence(sweep, 500) == "at 500 Hz: none of these motions keeps up");
  CHECK(compare::interactive_sentences(sweep).size() == 3);
}

TEST_CASE("the most accurate motion at a rate is held against the other family's") {
  const auto at_60 = [](const std::vector<SweepRow>& rows, double uncertainty = 0.5) {
    return compare::interactive_sentence(swept(rows, uncertainty), 60);
  };
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 0.9, 3)}),
             Contains("at 60 Hz: log_strain q1, 2x2x2 cells, steps of 10 ms are the most accurate that keep "
                      "up: error 3 %, 0.9 s of computing a second; the most accurate springs: springs "
                      "hybrid, 2x2x2 cells, steps of 10 ms: error 4 %, 0.2 s"));
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 0.9, 5)}),
             Contains("springs hybrid") && Contains("; the most accurate finite elements: log_strain q1"));
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 1.1, 3)}),
             Contains("; no finite elements keep up"));
  CHECK_THAT(at_60({elements(0.01, 0.2, 4)}), Contains("; no springs keep up"));
  // 4 - 3 is more than 0.5 and less than 1.5; below 5 nothing can be told
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 0.9, 3)}, 0.5), !Contains("does not tell"));
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 0.9, 3)}, 1.5),
             Contains("uncertainty of 1.5 % does not tell from the best"));
  CHECK_THAT(at_60({springs(0.01, 0.2, 4), elements(0.01, 0.9, 3)}, 5),
             Contains("error below the reference's uncertainty of 5 %") && !Contains("does not tell"));
}

TEST_CASE("an error that is small by accident is told, with the most accurate motion that is not") {
  const std::vector<SweepRow> rows{springs(0.01, 0.2, 2), springs(0.01, 5, 20, 4), elements(0.01, 0.9, 9)};
  const std::string sentence = compare::interactive_sentence(swept(rows), 60);
  CHECK_THAT(sentence, Contains("error 2 % by accident (more cells and shorter steps lead to 20 %)"));
  CHECK_THAT(sentence, Contains("the most accurate not by accident: log_strain q1"));
  // what the reference does not tell apart is no accident
  CHECK_THAT(compare::interactive_sentence(swept(rows, 19), 60), !Contains("accident"));
}

TEST_CASE(
    "a quick sweep in time has all designs with the case's step, its own and finite elements with three",
    "[long]") {
  int n_calls = 0;
  const Sweep sweep =
      compare::sweep_motion(block(), compare::Extent::quick, [&](const Sweep&) { ++n_calls; });
  const auto designs = msm::methods(block().material);
  REQUIRE(sweep.rows.size() == 3 * 3 + 3 * (designs.size() - 1) + 3 * 3);
  CHECK(n_calls == static_cast<int>(sweep.rows.size()));
  for (const cases::Design design : designs)
    CHECK(rows_of(sweep, "springs " + cases::name_of(design)).size() ==
          (design == cases::Design::hybrid ? 9 : 3));
  CHECK(sweep.reference->field.uncertainty_percent > 0);
  CHECK(sweep.reference->field.uncertainty_percent < 20); // coarse as the meshes are
  int n_moved = 0;
  for (const SweepRow& motion : sweep.rows) {
    const cases::Solution& found = motion.run.first;
    INFO(full_name(motion.variant) << " " << found.message);
    CHECK(motion.field_error_percent.has_value() == (found.status == cases::Status::converged));
    CHECK(found.message.empty() == motion.field_error_percent.has_value());
    if (!motion.field_error_percent) continue;
    ++n_moved;
    CHECK(std::isfinite(*motion.field_error_percent));
    CHECK(motion.run.first_seconds.at(0) > 0);
  }
  CHECK(n_moved > 18);
  const auto fem = rows_of(sweep, "log_strain q1_bbar"), own = rows_of(sweep, "springs hybrid");
  REQUIRE(fem.size() == 9);
  // coarsest with the longest step, finest with the shortest
  CHECK(fem.back()->field_error_percent.value() < 0.5 * fem.front()->field_error_percent.value());
  CHECK(own.back()->field_error_percent.value() < own.front()->field_error_percent.value());
  REQUIRE(sweep.plan.left_out.size() == 1);
  CHECK(sweep.plan.left_out[0].reason == "--quick was asked for");
  std::ostringstream text, csv;
  compare::write_sweep_text(text, sweep);
  CHECK_THAT(text.str(), Contains("\nat 60 Hz: ") && Contains("\nleft out: "));
  compare::write_sweep_csv(csv, sweep);
  const std::string lines = csv.str();
  CHECK(std::count(lines.begin(), lines.end(), '\n') == static_cast<int>(sweep.rows.size()) + 1);
  const auto document = compare::sweep_to_json(sweep);
  CHECK(document["motions"].size() == sweep.rows.size());
  CHECK(document["left_out"].size() == 1);
  CHECK(document["conclusions"].size() == 3);
}

TEST_CASE("a design that is refused is a failed row of a sweep in time, with the reason") {
  cases::Case auxetic = block(); // its own design takes a negative Poisson's ratio
  std::get<cases::LinearElastic>(auxetic.material).poissons_ratio = -0.1;
  auxetic.msm.design = cases::Design::moduli;
  auxetic.dynamics->end = 0.01;
  const Sweep sweep = quickly(auxetic);
  const auto refused = rows_of(sweep, "springs hybrid"), own = rows_of(sweep, "springs moduli");
  REQUIRE(refused.size() == 3);
  for (const SweepRow* row : refused) {
    CHECK(row->run.first.status == cases::Status::failed);
    CHECK_THAT(row->run.first.message, Contains("nu"));
    CHECK_FALSE(row->field_error_percent);
  }
  REQUIRE(own.size() == 9);
  CHECK(own.back()->field_error_percent);
  const auto document = compare::sweep_to_json(sweep);
  for (const auto& motion : document["motions"])
    CHECK(motion["error_percent"].is_null() == (motion["status"] == "failed"));
}

TEST_CASE("the springs of a sweep are all that the material has, and what is too large is left out by name") {
  std::vector<compare::LeftOut> left_out;
  const auto swept_of = [&](const cases::Material& material, compare::Extent extent) {
    return compare::springs_to_sweep(material, {{2, 2, 2}, {40, 40, 40}}, extent, left_out);
  };
  const auto full = swept_of(cases::LinearElastic{1, 0.3}, compare::Extent::full);
  const auto n_designs = msm::methods(cases::LinearElastic{1, 0.3}).size();
  CHECK(full.size() + left_out.size() == 2 * n_designs);
  CHECK(left_out.size() == 6); // designs of others with 206,763 unknowns
  for (const auto& springs : full)
    CHECK((springs.settings == compare::Settings::one) == cases::is_of_others(springs.design));
  for (const auto& springs : swept_of(cases::LinearElastic{1, 0.3}, compare::Extent::quick))
    CHECK(springs.settings == compare::Settings::one);
  const cases::TransverselyIsotropic muscle{2, 1, 0.3, 0.3, 0.5, Eigen::Vector3d::UnitX()};
  for (const auto& springs : swept_of(muscle, compare::Extent::full))
    CHECK((springs.design == cases::Design::transverse || springs.design == cases::Design::midline));
}

TEST_CASE("the figure of a sweep in time has two blocks of points for every method, and the front") {
  const TemporaryFolder folder;
  Sweep sweep = swept({springs(0.005, 0.1, 9), springs(0.0025, 0.3, 8), springs(0.005, 0.9, 3, 4),
                       springs(0.005, 0.2, std::nullopt), elements(0.005, 0.5, 4)});
  sweep.definition = block();
  compare::plot_sweep(folder.path.string(), sweep);
  const std::string points = content(folder.path / "motion_sweep_points.csv");
  std::vector<std::size_t> n_rows{0}; // lines of every block, its header too
  std::istringstream lines(points);
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty())
      ++n_rows.back();
    else if (n_rows.back() > 0)
      n_rows.push_back(0);
  }
  CHECK(n_rows == std::vector<std::size_t>{3, 2, 2, 2, 5, 0}); // the front: 0.1, 0.3, 0.5 and 0.9 s
  CHECK_THAT(content(folder.path / "motion_sweep.gp"), Contains("linetypes[2] = [2, 1]"));
}

TEST_CASE("a sweep in time says what it cannot sweep") {
  CHECK_THROWS_AS(quickly(block("near 2.5 5 20")), cases::InputError);
  cases::Case odd = block();
  odd.dynamics->end = 0.065;
  CHECK_THROWS_AS(quickly(odd), cases::InputError);
  cases::Case at_rest = block();
  at_rest.loads[0].scale(0);
  CHECK_THROWS_WITH(quickly(at_rest), Contains("do not move"));
}

} // namespace motion_sweeps
