#include "compare/thesis/advice.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

/// The case file's material and cell, which the stiffnesses are made independent of.
msm::CellStiffness over_modulus_and_edge(const msm::CellStiffness& k, const cases::Scene& scene) {
  const double youngs_modulus = std::get<cases::LinearElastic>(scene.definition.material).youngs_modulus;
  const double edge = msm::cube_edge(cases::cell_vertices(scene.mesh, 0));
  const double scale = youngs_modulus * edge;
  return {k.edge / scale, k.face_diagonal / scale, k.internal_diagonal / scale, k.volume / youngs_modulus};
}

Advice advise_on(const AdviceQuestion& asked, const Solutions& solutions) {
  const std::vector<JobPair> jobs = advice_jobs(asked);
  std::vector<CubeSolve> solves;
  for (const JobPair& test : jobs) solves.push_back({solutions.at(test.fem), solutions.at(test.msm)});
  Advice advice{asked.poissons_ratio, asked.design};
  const Comparison& msm = solves.front().msm;
  if (msm.answers.design) advice.stiffness = over_modulus_and_edge(msm.answers.design->stiffness, msm.scene);
  advice.cube = cube_errors(solves);
  const auto trace_of_worst = [&](const LoadSetErrors& errors) {
    return errors.worst ? trace_of(jobs[errors.worst_test]) : Trace{};
  };
  advice.small_trace = trace_of_worst(advice.cube.small);
  advice.large_trace = trace_of_worst(advice.cube.large);
  // With E = 1 MPa and a cell of 1 mm, the stiffnesses in N/m are a thousand times those over E L0.
  advice.trace.command = shell_command({"design", "--young", "1", "--poisson",
                                        fmt::format("{}", asked.poissons_ratio), "--method", asked.design});
  return advice;
}

/// Over both load sets; nothing for a design that failed or is not stable somewhere.
std::optional<double> worst_error(const Advice& advice) {
  return advice.cube.is_stable() ? advice.cube.worst() : std::nullopt;
}

} // namespace

void recommend(std::vector<Advice>& advice) {
  for (Advice& candidate : advice) {
    const auto worst = worst_error(candidate);
    candidate.is_recommended =
        worst && std::none_of(advice.begin(), advice.end(), [&](const Advice& other) {
          const auto others = worst_error(other);
          const bool is_rival = other.poissons_ratio == candidate.poissons_ratio && &other != &candidate;
          return is_rival && others && (*others < *worst || (*others == *worst && &other < &candidate));
        });
  }
}

std::vector<AdviceQuestion> advice_questions() {
  std::vector<AdviceQuestion> questions;
  for (const double nu : {0.2, 0.3, 0.35, 0.45, 0.49})
    for (const cases::Design method : msm::methods()) questions.push_back({nu, cases::name_of(method)});
  return questions;
}

std::vector<JobPair> advice_jobs(const AdviceQuestion& asked) {
  const auto& [nu, design] = asked;
  std::vector<JobPair> jobs;
  for (const CubeTest& test : cube_tests)
    jobs.push_back(
        designed_jobs({"", "linear_elastic", nu, design, nu, test.load_set, test.test, "", "%", 0}, design));
  return jobs;
}

std::vector<Advice> advise(const std::vector<AdviceQuestion>& questions, const Solutions& solutions) {
  std::vector<Advice> advice;
  for (const AdviceQuestion& asked : questions) advice.push_back(advise_on(asked, solutions));
  recommend(advice);
  return advice;
}

} // namespace springproof::compare
