#include "compare/solve/solve_jobs.hpp"

#include "cases/case/read_case.hpp"
#include "compare/error_bars/auto_fem.hpp"

#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

namespace fs = std::filesystem;

using cases::Side;
using compare::Answers;
using compare::Solved;
using compare::SolveJob;

namespace {

const std::string linear_elastic = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/thesis/linear_elastic/";
// Two cells to a side: the loads are those of the thesis's nodes.
const std::vector<std::string> coarse{"body.cells=[2, 2, 2]", "fem.formulation=small_strain"};

SolveJob shear(std::optional<Side> only, std::vector<std::string> more = {}) {
  more.insert(more.begin(), coarse.begin(), coarse.end());
  return {linear_elastic + "cube_shear_small.toml", more, only};
}

std::vector<Solved> solve(const std::vector<SolveJob>& jobs, int n_workers,
                          const std::string& program = SPRINGPROOF_PROGRAM) {
  return compare::solve_jobs(jobs, [&](const std::vector<compare::Question>& questions) {
    return compare::answer_all(questions, compare::FinishedCases("", {}), compare::solve_fem,
                               {n_workers, program});
  });
}

bool is_same(const cases::Solution& a, const cases::Solution& b) {
  return a.status == b.status && a.displacement == b.displacement && a.cell_volume == b.cell_volume &&
         a.residual == b.residual && a.unknowns == b.unknowns && a.newton_iterations == b.newton_iterations;
}

Answers solve_here(const SolveJob& job) {
  const cases::Scene scene = cases::make_scene(cases::read_case(job.case_file, job.settings));
  return compare::solve(scene, {job.only}, compare::solve_fem);
}

} // namespace

TEST_CASE("what a worker chose for a case that leaves it open comes back with its numbers") {
  const SolveJob job = shear(
      Side::fem,
      {"fem.formulation=auto", "load[0].value=[0.00001, 0, 0]",
       R"(expect=[{measure="alpha_1", error_percent=[-50, 50], reference="regression", reason="wide"}])"});
  const Answers there = solve({job}, 1).front().answers, here = solve_here(job);
  REQUIRE(here.resolved.formulation == cases::Formulation::small_strain);
  CHECK(there.resolved.formulation == cases::Formulation::small_strain);
  REQUIRE(here.choices.size() == 1);
  REQUIRE(there.choices.size() == 1);
  CHECK(there.choices[0].substr(0, 24) == here.choices[0].substr(0, 24)); // seconds stand behind
  CHECK(is_same(there.fem.solution, here.fem.solution));
}

TEST_CASE("workers give the numbers of this process to the last bit, one worker or several") {
  const std::vector<SolveJob> jobs{shear(std::nullopt), shear(Side::msm, {"msm.design=moduli"}),
                                   shear(Side::fem)};
  const auto by_one = solve(jobs, 1), by_three = solve(jobs, 3);
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    CAPTURE(j);
    const Answers here = solve_here(jobs[j]);
    for (const Answers* there : {&by_one[j].answers, &by_three[j].answers}) {
      CHECK(is_same(there->fem.solution, here.fem.solution));
      CHECK(is_same(there->msm.solution, here.msm.solution));
      REQUIRE(there->design.has_value() == here.design.has_value());
      if (here.design) CHECK(there->design->stiffness.edge == here.design->stiffness.edge);
    }
  }
}

TEST_CASE(
    "settings that make no case, and loads that cannot be carried, fail their own side with the reason") {
  const auto solved = solve({shear(Side::msm, {"msm.design=hybrid", "material.poissons_ratio=-0.2"}),
                             shear(Side::msm, {"msm.design=given", "msm.stiffness=[0, 0, 30]"}),
                             {linear_elastic + "no_such_case.toml", {}, Side::fem},
                             shear(Side::msm)},
                            2);
  for (const std::size_t j : {0, 1}) CHECK(solved[j].answers.msm.solution.status == cases::Status::failed);
  CHECK_THAT(solved[0].answers.msm.solution.message, Catch::Contains("0 and more"));
  CHECK_FALSE(solved[1].answers.msm.solution.message.empty()); // diagonals alone are a mechanism
  CHECK(solved[2].answers.fem.solution.status == cases::Status::failed);
  CHECK(solved[2].answers.msm.solution.status == cases::Status::skipped);
  CHECK(solved[3].answers.msm.solution.status == cases::Status::converged);
}

TEST_CASE("workers read no file: what was parsed is what is solved") {
  const TemporaryFolder folder;
  const std::string file = folder.write("case.toml", "");
  fs::copy_file(shear({}).case_file, file, fs::copy_options::overwrite_existing);
  const auto questions = compare::read_questions({file}, coarse, {Side::msm});
  fs::remove(file);
  const auto answers = compare::answer_all(questions, compare::FinishedCases("", {}), compare::solve_fem,
                                           {1, SPRINGPROOF_PROGRAM});
  CHECK(is_same(answers[0].msm.solution, solve_here(shear(Side::msm)).msm.solution));
}

TEST_CASE("a worker that crashes is a failed side that says so") {
  const auto solved = solve({shear(Side::msm)}, 1, "false");
  CHECK(solved[0].answers.msm.solution.status == cases::Status::failed);
  CHECK_THAT(solved[0].answers.msm.solution.message, Catch::Contains("status 1"));
}
