#include "compare/report/pages.hpp"

#include "cases/case/read_case.hpp"
#include "compare/provenance/whole_file.hpp"
#include "compare/solve/springs.hpp"
#include "compare/study/write_study.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

using namespace springproof;

using Catch::Contains;

namespace {

cases::Case small_cube() {
  cases::Case definition = cases::read_case(SPRINGPROOF_SOURCE_DIR "/cases/gates/sheared_cube.toml");
  std::get<cases::Box>(definition.body).cells = {2, 2, 2};
  definition.expectations.clear();
  return definition;
}

/// The data of a written page.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "id=\"report-data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

} // namespace

TEST_CASE("a case's page has its verdict, its measures, both bodies and the designs' ranking") {
  const compare::Comparison comparison = compare::compare_case(small_cube());
  const compare::Ranking ranking = compare::rank_designs(
      comparison.scene, {cases::Design::moduli, cases::Design::hybrid}, comparison.answers);
  const auto page =
      compare::case_page_to_json(comparison, &ranking, {"build/springproof run x.toml --report"});
  CHECK(page["verdict"] == compare::verdict_of(comparison));
  REQUIRE(page["case"]["measures"].size() == 2);
  CHECK(page["case"]["measures"][0]["error_percent"] == *comparison.measures[0].error_percent);
  CHECK(page["views"]["views"][0].contains("fem"));
  CHECK(page["views"]["views"][0].contains("springs"));
  CHECK(page["ranking"]["designs"].size() == 2);
  CHECK(page["commands"][0] == "build/springproof run x.toml --report");
}

TEST_CASE("a case's page says what its springs are, how far they are stable, and all that is warned of") {
  cases::Case definition = small_cube();
  definition.measures.clear();
  cases::Scene scene = cases::make_scene(definition);
  scene.remarks = {"a piece was left out"};
  compare::Answers answers;
  answers.design = compare::design_for(scene);
  answers.design->warnings = {"the lattice has other moduli"};
  const compare::Comparison comparison = compare::comparison_of(scene, answers);
  const auto page = compare::case_page_to_json(comparison, nullptr, {});
  const auto& springs = page["springs"];
  CHECK(springs["design"] == "hybrid");
  const msm::CellStiffness& k = answers.design->stiffness;
  REQUIRE(springs["stiffness_N_per_m"].size() == 3);
  CHECK(springs["stiffness_N_per_m"][0] == 1e3 * k.edge);
  CHECK(springs["stiffness_N_per_m"][1] == 1e3 * k.face_diagonal);
  CHECK(springs["stiffness_N_per_m"][2] == 1e3 * k.internal_diagonal);
  CHECK(springs["volume_stiffness_MPa"] == k.volume);
  CHECK(springs["moduli"]["youngs_modulus"].get<double>() == Approx(0.3).epsilon(1e-10)); // the material's
  CHECK(springs["moduli"]["poissons_ratio"].get<double>() == Approx(0.49).epsilon(1e-10));
  CHECK(springs["stability"]["compression"].get<double>() < 1);
  CHECK(page["case"]["warnings"] ==
        nlohmann::ordered_json{"a piece was left out", "the lattice has other moduli"});
  compare::Comparison theirs = comparison;
  theirs.answers.msm_source = "another.vtu";
  CHECK(compare::case_page_to_json(theirs, nullptr, {})["springs"].is_null());
}

TEST_CASE("springs that differ from cell to cell or from axis to axis are on the page one by one") {
  cases::Case definition = small_cube();
  std::get<cases::Box>(definition.body).cells = {2, 2, 4}; // cells that are no cubes
  const cases::Scene scene = cases::make_scene(definition);
  compare::Answers answers;
  answers.design = compare::design_for(scene);
  const auto springs =
      compare::case_page_to_json(compare::comparison_of(scene, answers), nullptr, {})["springs"];
  CHECK(springs["stiffness_N_per_m"].is_null());
  CHECK(springs["cell"]["springs"].size() > 12);
  CHECK(springs["stability"].is_null());
}

TEST_CASE("a page draws some two thousand times of a motion at most, and says so") {
  const auto page_of = [](double end) {
    cases::Case definition = small_cube();
    definition.material_dynamics.density = 1000;
    definition.measures = {definition.measures.front()};
    definition.measures.front().over_time = cases::OverTime::end;
    definition.loads.front().scale(0.01);
    definition.dynamics.emplace();
    definition.dynamics->step = 1e-3;
    definition.dynamics->end = end;
    definition.dynamics->write_every = 1000;
    return compare::case_page_to_json(compare::compare_case(definition, {cases::Side::msm}), nullptr,
                                      {})["case"]["motion"];
  };
  const auto whole = page_of(0.5), thinned = page_of(2.5);
  CHECK(whole["time"].size() == 501);
  CHECK(whole["drawn_every"] == 1);
  CHECK(thinned["drawn_every"] == 2);
  CHECK(thinned["time"].size() == 1251);
  CHECK(thinned["measures"][0]["msm"].size() == 1251);
  CHECK(thinned["time"][1] == Approx(2e-3));
}

TEST_CASE("a verdict names the worst measure, or why there is nothing to compare") {
  const cases::Case definition = small_cube();
  const compare::Comparison both = compare::compare_case(definition);
  double worst = 0;
  for (const compare::MeasuredValue& m : both.measures) worst = std::max(worst, std::abs(*m.error_percent));
  CHECK_THAT(compare::verdict_of(both), Contains(fmt::format("up to {:.2f} % (alpha_2)", worst)) &&
                                            Contains("finite elements on the same mesh"));
  CHECK_THAT(compare::verdict_of(compare::compare_case(definition, {cases::Side::msm})),
             Contains("the finite elements were not solved"));
  compare::Comparison failed = both;
  failed.answers.msm.solution.status = cases::Status::failed;
  failed.answers.msm.solution.message = "springs: no equilibrium";
  CHECK(compare::verdict_of(failed) == "There is nothing to compare: springs: no equilibrium");
}

TEST_CASE("texts of a case are data of its page: none becomes markup or script") {
  cases::Case definition = small_cube();
  definition.name = "a<b>&'c' --x";
  definition.description =
      "</script><script>document.title='owned'</script><!-- <img src=x onerror=alert(1)>";
  definition.measures[0].name = "<b>alpha</b>";
  const TemporaryFolder folder;
  const std::string out = folder.path.string();
  compare::write_case_page(out, compare::compare_case(definition), nullptr, {"springproof run '<i>'"});
  const std::string page = compare::read_file(out + "/" + definition.name + ".html");
  CHECK_THAT(page, Contains("<title>a&lt;b&gt;&amp;&#39;c&#39; --x: springs"));
  CHECK_THAT(page, !Contains("owned'</script>") && !Contains("<img src=x") && !Contains("<b>alpha") &&
                       !Contains("run '<i>'"));
  const nlohmann::json data = data_of(page);
  CHECK(data["heading"] == definition.name);
  CHECK(data["subheading"] == definition.description);
  CHECK(data["case"]["measures"][0]["name"] == "<b>alpha</b>");
  CHECK_THAT(compare::read_file(out + "/" + definition.name + "_bodies/bodies.png"), Contains("PNG"));
  CHECK_THAT(compare::read_file(out + "/" + definition.name + "_bodies/bodies.svg"),
             Contains("a&lt;b") && !Contains("a<b"));
}

// What gnuplot is told of a stranger are texts of titles: every script of compare/write/plots was looked
// through, with the words of ccx, valgrind, worker processes and confined readers. Files that gnuplot opens
// have names of ours (draw()'s callers), in the case's folder.
TEST_CASE("a case's name is no name of a file of gnuplot's: no pipe, no block of data, no special file") {
  cases::Case definition = small_cube();
  definition.name = GENERATE("<touch P;cat x", "|touch P", "$DATA", "''", "+", "-e x", "`touch P`", "@x");
  const TemporaryFolder folder;
  const std::string out = folder.path.string();
  compare::write_case_page(out, compare::compare_case(definition, {cases::Side::msm}), nullptr, {});
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
    CHECK(entry.path().filename() != "P");
  CHECK_THAT(compare::read_file(out + "/" + definition.name + "_bodies/bodies.png"), Contains("PNG"));
  const std::string script = compare::read_file(out + "/" + definition.name + "_bodies/bodies.gp");
  const std::size_t titles = script.find("array titles[1] = ['"), end = script.find('\n', titles);
  REQUIRE(titles != std::string::npos);
  CHECK_THAT(script.substr(0, titles) + script.substr(end), !Contains(definition.name + "_bodies"));
}
