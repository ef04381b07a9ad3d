#include "compare/study/write_study.hpp"

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/table/table.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/unwrapped.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <sstream>

using namespace springproof;

using compare::Trial;

namespace {

Trial with_error(const std::string& name, double worst, bool is_stable) {
  Trial ranked{name};
  ranked.worst = worst;
  ranked.is_stable = is_stable;
  return ranked;
}

/// A ranking whose finite elements were solved.
compare::Ranking ranking_of(const std::vector<Trial>& designs = {}) {
  compare::Ranking ranking{"case", {}, {}};
  ranking.fem.solution.status = cases::Status::converged;
  ranking.designs = designs;
  return ranking;
}

cases::Scene small_shear(const std::vector<std::string>& settings = {}) {
  return cases::make_scene(
      cases::read_case(compare::cases_folder() + "/thesis/linear_elastic/cube_shear_small.toml", settings));
}

} // namespace

TEST_CASE("designs come by their worst error, then those that failed, then those refused") {
  Trial failed{"failed"}, refused{"refused"};
  failed.failure = "no equilibrium";
  refused.refusal = "not for this material";
  compare::Ranking ranking = ranking_of({refused, with_error("worse", 7, true), failed,
                                         with_error("unstable", 1, false), with_error("best", 3, true)});
  compare::sort_by_error(ranking.designs);
  std::vector<std::string> names;
  for (const Trial& ranked : ranking.designs) names.push_back(ranked.name);
  CHECK(names == std::vector<std::string>{"unstable", "best", "worse", "failed", "refused"});
  REQUIRE(ranking.recommended() != nullptr);
  CHECK(ranking.recommended()->name == "best");
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("Use best here: errors up to 3.00 %"));
  std::ostringstream text;
  compare::write_ranking_text(text, ranking);
  CHECK_THAT(text.str(), Catch::Contains("> best") && Catch::Contains("failed failed: no equilibrium") &&
                             Catch::Contains("refused refused: not for this material"));
}

TEST_CASE("designs that are refused for one reason share its line") {
  Trial first{"first"}, second{"second"}, other{"other"};
  first.refusal = second.refusal = "not on this mesh";
  other.refusal = "not for this material";
  std::ostringstream text;
  compare::write_ranking_text(text, ranking_of({first, other, second, with_error("best", 3, true)}));
  CHECK_THAT(text.str(), Catch::Contains("    first, second refused: not on this mesh\n") &&
                             Catch::Contains("    other refused: not for this material\n"));
}

TEST_CASE("a ranking's text ends with its advice, in lines of 100 columns, whatever the reasons say") {
  Trial refused{"refused"};
  for (int n = 0; n < 40; ++n) refused.refusal += "reason " + std::to_string(n) + " ";
  compare::Ranking ranking =
      ranking_of({with_error("best", 3, true), with_error("worse", 7, false), refused});
  ranking.designs[0].springs = std::string(150, 'k');
  std::ostringstream out;
  compare::write_ranking_text(out, ranking);
  std::istringstream in(out.str());
  for (std::string line; std::getline(in, line);) CHECK(compare::n_characters(line) <= compare::screen_width);
  CHECK_THAT(unwrapped(out.str()), Catch::EndsWith(" " + compare::advice_of(ranking) + " "));
}

TEST_CASE("a ranking's files have every design: its springs, or why it has none") {
  Trial failed{"failed"};
  failed.failure = "no equilibrium, it says";
  compare::Ranking ranking = ranking_of({with_error("best", 3, true), failed});
  ranking.designs[0].worst_at = "top";
  ranking.designs[0].milliseconds = 1.5;
  ranking.designs[0].springs = "k_e = 3 N/m";
  const TemporaryFolder folder;
  const std::string path = folder.path.string();
  compare::write_rankings(path, {ranking});
  CHECK(
      content(folder.path / "ranking.csv") ==
      "case,design,recommended,worst_error_percent,worst_error_uncertainty_percent,worst_at,"
      "worst_volume_error_percent,stable,has_moduli,milliseconds,milliseconds_a_step,springs,refused,failed\n"
      "case,best,1,3,,top,,1,,1.5,,k_e = 3 N/m,,\n"
      "case,failed,0,,,,,0,,0,,,,\"no equilibrium, it says\"\n");
  CHECK_THAT(content(folder.path / "ranking.txt"), Catch::Contains("> best") && Catch::Contains("Use best"));
  const auto document = nlohmann::json::parse(content(folder.path / "ranking.json"));
  CHECK(document["cases"][0]["designs"][0]["springs"] == "k_e = 3 N/m");
  CHECK(document["cases"][0]["designs"][1]["failed"] == "no equilibrium, it says");
}

TEST_CASE("a ranking fails with its case, and not with a design that is refused or fails") {
  Trial failed{"failed"}, refused{"refused"};
  failed.failure = "no equilibrium";
  refused.refusal = "not for this material";
  compare::Ranking ranking = ranking_of({with_error("own", 3, true), failed, refused});
  CHECK(ranking.is_sound());
  ranking.is_case_sound = false;
  CHECK_FALSE(ranking.is_sound());
  ranking.is_case_sound = true;
  ranking.designs = {failed, refused}; // nothing was answered
  CHECK_FALSE(ranking.is_sound());
  ranking.designs = {with_error("own", 3, true)};
  ranking.fem.solution.status = cases::Status::failed;
  CHECK_FALSE(ranking.is_sound());
}

TEST_CASE("of a motion the advice says whether a step keeps up with a screen") {
  compare::Ranking ranking = ranking_of({with_error("best", 3, true)});
  ranking.designs[0].milliseconds_a_step = 8.1;
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("8.1 ms a step: keeps 60 Hz"));
  ranking.designs[0].milliseconds_a_step = 17;
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("17 ms a step: does not keep 60 Hz"));
}

TEST_CASE("springs that steps in real time bring to rest are stable, those of iterations that end are not") {
  cases::Solution springs;
  springs.status = cases::Status::converged;
  springs.from_equilibrium.emplace();
  CHECK_FALSE(compare::is_stable(springs));
  springs.from_equilibrium->rest = {1.5, 90};
  CHECK(compare::is_stable(springs));
  springs.inverted_cells = 1;
  CHECK_FALSE(compare::is_stable(springs));
}

TEST_CASE("the sentence names the designs that the reference's uncertainty does not tell from the best") {
  compare::Ranking ranking = ranking_of({with_error("best", 3, true), with_error("close", 3.4, true),
                                         with_error("unstable", 3.1, false), with_error("far", 5, true)});
  CHECK_THAT(compare::advice_of(ranking), !Catch::Contains("does not tell"));
  for (Trial& ranked : ranking.designs) ranked.worst_bar = 0.3;
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("errors up to 3.00 +- 0.3 %") &&
                                              Catch::Contains("does not tell it from close: "));
}

// Other sentences that advise: verdict_of(), which shares the clause on the finite elements, and the one that
// `tables` prints, which ranks by both load sets and has no bars.
TEST_CASE("the advice has the numbers of the table, and its reasons hold for them") {
  std::mt19937 chance(7);
  const auto any = [&](double most) { return most * (double(chance()) / 4294967295.0); };
  for (int round = 0; round < 200; ++round) {
    compare::Ranking ranking = ranking_of();
    ranking.fem.solve_seconds = any(0.02);
    const bool has_limits = any(1) < 0.8;
    for (const char* name : {"a", "b", "c", "d", "e", "f"}) {
      Trial ranked = with_error(name, any(10), any(1) < 0.8);
      ranked.worst_at = "shift";
      if (has_limits) ranked.worst_bar = any(4);
      if (any(1) < 0.8) ranked.misfit = any(0.1);
      ranked.milliseconds = any(20);
      ranking.designs.push_back(ranked);
    }
    compare::sort_by_error(ranking.designs);
    const std::string advice = compare::advice_of(ranking);
    CAPTURE(advice);
    std::map<std::string, const Trial*> row;
    for (const Trial& ranked : ranking.designs) row[ranked.name] = &ranked;
    std::smatch use;
    if (!std::regex_search(advice, use,
                           std::regex("Use (.) here: errors up to ([0-9.]+)( \\+- ([0-9.]+))? %.* in "
                                      "([0-9.]+) ms, (less|not less) than the ([0-9.]+) ms"))) {
      for (const Trial& ranked : ranking.designs) CHECK_FALSE(ranked.is_stable);
      continue;
    }
    const Trial& best = *row.at(use[1]);
    const auto has_moduli = [](const Trial& r) { return r.misfit && *r.misfit <= 0.05; };
    CHECK(best.is_stable);
    CHECK(std::stod(use[2]) == Approx(*best.worst).margin(0.005)); // rounded as printed
    CHECK(use[4].matched == has_limits);
    CHECK((use[6] == "less") == (best.milliseconds < 1e3 * ranking.fem.seconds()));
    CHECK_THAT(advice, Catch::Contains("whose own error on this mesh is not known"));
    std::smatch listed;
    std::set<std::string> others;
    if (std::regex_search(advice, listed,
                          std::regex("does not tell (it|the smallest error, of .,) from ([^:]+):")))
      for (const char c : listed.str(2))
        if (row.count(std::string(1, c)) > 0) others.insert(std::string(1, c));
    const auto lowest = std::find_if(ranking.designs.begin(), ranking.designs.end(),
                                     [](const Trial& r) { return r.is_stable; });
    const double reach = *lowest->worst + lowest->worst_bar.value_or(0);
    for (const Trial& ranked : ranking.designs) {
      const bool is_close = &ranked == &*lowest || *ranked.worst - ranked.worst_bar.value_or(0) < reach;
      CHECK((&ranked == &*lowest || others.count(ranked.name) > 0) == (ranked.is_stable && is_close));
      if (&ranked != &*lowest && others.count(ranked.name) == 0) continue;
      CHECK((has_moduli(best) || !has_moduli(ranked)));
      if (has_moduli(best) == has_moduli(ranked)) CHECK(best.milliseconds <= ranked.milliseconds);
    }
    CHECK((advice.find("Its lattice has other moduli") != std::string::npos) ==
          (best.misfit && !has_moduli(best)));
  }
}

TEST_CASE(
    "the finite elements' error is of the measures whose limit is known, and the sentence counts them") {
  compare::Ranking ranking = ranking_of();
  Trial own = with_error("hybrid", 3, true);
  own.measures = {{"shift", "mm", 1, 1.03, 3}, {"volume", "mm3", 1000, 1000, 0}};
  own.measures[1].fem_limit = compare::Limit{};
  own.measures[1].fem_limit->value = 1000;
  own.measures[1].fem_limit->uncertainty = 1;
  own.measures[1].fem_error_percent = 0;
  ranking.designs = {own};
  CHECK_THAT(
      compare::advice_of(ranking),
      Catch::Contains("which themselves err by up to 0.00 +- 0.1 % on this mesh in the 1 of 2 measures whose "
                      "limit is known."));
  own.measures[0].fem_limit = own.measures[1].fem_limit;
  own.measures[0].fem_limit->value = 1.02;
  own.measures[0].fem_limit->uncertainty = 0.0204;
  own.measures[0].fem_error_percent = -1.96;
  ranking.designs = {own};
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("err by up to 1.96 +- 2 % on this mesh."));
  for (compare::MeasuredValue& measured : own.measures)
    measured.fem_limit.reset(), measured.fem_error_percent.reset();
  ranking.designs = {own};
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("whose own error on this mesh is not known."));
}

TEST_CASE("without a stable design none is recommended, and the sentence says so") {
  compare::Ranking ranking = ranking_of({with_error("unstable", 1, false)});
  CHECK(ranking.recommended() == nullptr);
  CHECK_THAT(compare::advice_of(ranking), Catch::Contains("No design"));
  CHECK(compare::ranking_to_json(ranking)["recommended"].is_null());
}

TEST_CASE("the worst error of a trial is of lengths and angles before volumes, with its own error bar") {
  compare::Comparison run;
  run.answers.msm.solution.status = cases::Status::converged;
  run.answers.msm.solution.outcome = cases::Outcome::stable_equilibrium;
  run.measures = {{"up", "mm", 1, 1.02, 2}, {"down", "mm", 1, 0.97, -3}, {"volume", "mm3", 1, 0.9, -10}};
  run.measures[1].error_uncertainty_percent = 0.5;
  run.scene.definition.measures.resize(3);
  run.scene.definition.measures[2].kind = cases::measures::Volume{};
  const Trial trial = compare::trial_of(run);
  CHECK(*trial.worst == 3);
  CHECK(trial.worst_at == "down");
  CHECK(*trial.worst_bar == 0.5);
  CHECK(*trial.worst_volume == 10);
  CHECK(trial.is_stable);
  run.measures.erase(run.measures.begin(), run.measures.begin() + 2);
  run.scene.definition.measures.erase(run.scene.definition.measures.begin(),
                                      run.scene.definition.measures.begin() + 2);
  CHECK(compare::trial_of(run).worst_at == "volume"); // there is nothing else
}

TEST_CASE("a design that a case cannot have is refused, and the best has the errors of its lattice",
          "[verification][long]") {
  const std::vector<cases::Design> designs{cases::Design::hybrid, cases::Design::lloyd, cases::Design::given};
  const compare::Ranking ranking = compare::rank_designs(small_shear(), designs);
  REQUIRE(ranking.designs.size() == 3);
  CHECK(ranking.designs.back().name == "given"); // the case gives no stiffness
  CHECK_THAT(ranking.designs.back().refusal, Catch::Contains("stiffness"));
  CHECK(ranking.designs.front().milliseconds > 0);
  CHECK(ranking.recommended()->name == "hybrid"); // lloyd's lattice is 14 % too stiff
}

TEST_CASE("designs are ranked by energy and stress too, whatever their cells consist of",
          "[verification][long]") {
  cases::Scene scene = small_shear();
  scene.definition.measures = {{"energy", cases::measures::StrainEnergy{}},
                               {"stress", cases::measures::Stress{{cases::TensorComponent::xz, {5, 5, 5}}}}};
  scene.definition.has_fields = true;
  const std::vector<cases::Design> designs{cases::Design::hybrid, cases::Design::lloyd,
                                           cases::Design::biquadratic, cases::Design::uniform};
  const compare::Ranking ranking = compare::rank_designs(scene, designs);
  REQUIRE(ranking.designs.size() == designs.size());
  CHECK_FALSE(ranking.fem.solution.fields);
  for (const Trial& ranked : ranking.designs) {
    CAPTURE(ranked.name, ranked.refusal, ranked.failure);
    REQUIRE(ranked.measures.size() == 2);
    // The load is 121 x 0.002 N on 100 mm^2. Over the height the shear stress of a bar is a parabola, 3/2 of
    // its mean in the middle; in a body as short as it is high, a few percent from it.
    const double in_the_middle = 1.5 * 121 * 0.002 / 100;
    CHECK(*ranked.measures[1].fem == Approx(in_the_middle).epsilon(0.05));
    CHECK(*ranked.measures[1].msm == Approx(in_the_middle).epsilon(0.05));
    CHECK(*ranked.measures[0].msm > 0);
    CHECK(ranked.worst);
  }
}

TEST_CASE("a case without measures cannot be ranked") {
  cases::Scene scene = small_shear();
  scene.definition.measures.clear();
  CHECK_THROWS_WITH(compare::rank_designs(scene, {cases::Design::hybrid}), Catch::Contains("[[measure]]"));
}

using Catch::Contains;

namespace {

/// Both models solved: one measure, whose limit is 100 +- 1 mm.
compare::Comparison solved(double fem, double msm) {
  compare::Comparison comparison;
  comparison.answers.fem.solution.status = comparison.answers.msm.solution.status = cases::Status::converged;
  comparison.answers.fem.setup_seconds = 0.5;
  comparison.answers.fem.solve_seconds = 1.5;
  comparison.answers.msm.solve_seconds = 0.1;
  compare::MeasuredValue measured{"u", "mm", fem, msm, msm - 100};
  measured.fem_limit = compare::Limit{100, 1, ""};
  measured.error_uncertainty_percent = 1;
  measured.fem_error_percent = fem - 100;
  comparison.measures = {measured};
  return comparison;
}

compare::Answer moved(double milliseconds_a_step) {
  compare::Answer answer;
  answer.solution.status = cases::Status::converged;
  answer.solution.trajectory.emplace();
  answer.solution.trajectory->time = {0, 0.1, 0.2};
  answer.setup_seconds = 10; // is of no step
  answer.solve_seconds = 2e-3 * milliseconds_a_step;
  return answer;
}

} // namespace

TEST_CASE("the verdict holds the springs' error against their mesh's as far as both are known") {
  const std::string springs = compare::verdict_of(solved(97, 80));
  CHECK_THAT(springs, Contains("The springs are up to 20.00 +- 1 % (u) from the truth") &&
                          Contains("themselves err by up to 3.00 +- 1 % on this mesh") &&
                          Contains("The springs err more than their mesh does."));
  CHECK_THAT(compare::verdict_of(solved(80, 97)),
             Contains("They err less than the finite elements on this mesh do"));
  CHECK_THAT(compare::verdict_of(solved(97, 98.5)),
             Contains("do not tell the springs' error from their mesh's"));
  compare::Comparison unknown = solved(97, 80);
  unknown.measures[0].fem_limit.reset();
  unknown.measures[0].fem_error_percent.reset();
  unknown.measures[0].error_uncertainty_percent.reset();
  CHECK_THAT(compare::verdict_of(unknown),
             Contains("from the finite elements on the same mesh") && !Contains("mesh does"));
}

TEST_CASE("times of equilibria are compared with their setup, and a step in time is held against a screen") {
  compare::Comparison comparison = solved(97, 80);
  CHECK(compare::time_of(comparison) ==
        "Time: the springs 0.1 s; the finite elements 2 s; the springs are 20 times as fast.");
  comparison.answers.msm.solve_seconds = 3;
  CHECK_THAT(compare::time_of(comparison), Contains("the finite elements are 1.5 times as fast."));
  comparison.answers.msm_source = "another.vtu"; // whose time nobody knows
  CHECK(compare::time_of(comparison) == "Time: the finite elements 2 s.");
  comparison.answers = {};
  CHECK(compare::time_of(comparison).empty());
  comparison.answers.fem = moved(31);
  comparison.answers.msm = moved(8.1);
  CHECK(compare::time_of(comparison) ==
        "Time: the springs 8.1 ms a step: keeps 60 Hz; the finite elements 31 ms a "
        "step: does not keep 60 Hz.");
}

TEST_CASE("a run's last lines are its verdict and its commands, which are never broken") {
  std::ostringstream out;
  const std::string command = "springproof run " + std::string(120, 'p') + ".toml --designs all";
  compare::write_verdict_text(out, solved(97, 80), {{"springproof run a.toml", "short"}, {command, "long"}});
  CHECK_THAT(out.str(), Catch::StartsWith("Verdict: The springs are up to ") &&
                            Catch::EndsWith("What to type next:\n"
                                            "  springproof run a.toml   # short\n"
                                            "  # long\n  " +
                                            command + "\n"));
}
