#include "compare/hard/stress.hpp"

#include "compare/gates/judge.hpp"
#include "compare/solve/estimate.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

const Answer* find_converged(const StressResult& result, const std::string& model) {
  for (const auto& [expected, answer, misses] : result.rows)
    if (expected.model == model && answer.converged()) return &answer;
  return nullptr;
}

} // namespace

bool StressResult::met() const {
  return std::all_of(rows.begin(), rows.end(), [](const StressRow& row) { return row.misses.empty(); });
}

std::optional<double> StressResult::hybrid_over_springs() const {
  const Answer *springs = find_converged(*this, "msm"), *hybrid = find_converged(*this, "hybrid");
  if (!springs || !hybrid || !(springs->solve_seconds > 0)) return std::nullopt;
  return hybrid->solve_seconds / springs->solve_seconds;
}

std::vector<Question> jobs_for(const cases::Case& hard_case, int n_threads) {
  const cases::Scene scene = make_scene_within_memory(hard_case);
  std::vector<Question> jobs;
  for (const cases::ExpectedOutcome& expected : hard_case.stress->expected) {
    Question job{scene, {expected.side}};
    job.request.n_threads = n_threads;
    cases::Case& definition = job.scene.definition;
    definition.name += " " + expected.model; // of what is kept
    if (expected.design) {
      definition.msm = {};
      definition.msm.design = *expected.design;
      definition.msm.where = hard_case.msm.where;
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

StressResult judge_stress(const cases::Case& hard_case, int n_threads, const std::vector<Answer>& answers) {
  StressResult result{hard_case, n_threads, {}};
  for (std::size_t r = 0; r < answers.size(); ++r) {
    const cases::ExpectedOutcome& expected = hard_case.stress->expected[r];
    result.rows.push_back({expected, answers[r], misses(*hard_case.stress, expected, answers[r])});
  }
  return result;
}

} // namespace springproof::compare
