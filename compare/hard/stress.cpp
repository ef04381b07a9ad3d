#include "compare/hard/stress.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/table/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <cmath>

namespace springproof::compare {

namespace {

const Answer* find_converged(const StressResult& result, const std::string& model) {
  for (const auto& [expected, answer, misses] : result.rows)
    if (expected.model == model && answer.converged()) return &answer;
  return nullptr;
}

bool is_finite(const cases::Solution& s) {
  return std::isfinite(s.residual) && std::isfinite(s.load_reached) &&
         std::isfinite(s.lowest_eigenvalue.value_or(0)) &&
         std::all_of(s.displacement.begin(), s.displacement.end(),
                     [](const Eigen::Vector3d& u) { return u.allFinite(); });
}

/// The lowest eigenvalue where the solver has it, else how many are negative.
std::string eigenvalue_text(const cases::Solution& s) {
  if (s.lowest_eigenvalue) return fmt::format("{:.3g}", *s.lowest_eigenvalue);
  if (s.negative_eigenvalues) return fmt::format("{} < 0", *s.negative_eigenvalues);
  return "-";
}

void write_row(std::ostream& out, const StressRow& row) {
  const cases::Solution& s = row.answer.solution;
  print(out, "  {:<7}{:<21} {:>7.4g} {:>9.1e} {:>6} {:>11} {:>9} {:>9.3f}  {}\n", row.expected.model,
        cases::name_of(s.outcome), s.load_reached, s.residual, s.newton_iterations, eigenvalue_text(s),
        s.inverted_cells, row.answer.seconds(), row.misses.empty() ? "as expected" : "DIFFERS");
  const std::string indent(9, ' ');
  for (const std::string& miss : row.misses) write_paragraph(out, miss, indent, indent);
  if (!s.message.empty()) write_paragraph(out, s.message, indent, indent);
}

Json row_to_json(const StressRow& row) {
  Json json = side_to_json(row.answer);
  json["side"] = row.expected.model;
  json["outcome"] = cases::name_of(row.answer.solution.outcome);
  json["expected"] = cases::name_of(row.expected.outcome);
  json["met"] = row.misses.empty();
  json["misses"] = row.misses;
  return json;
}

Json result_to_json(const StressResult& result) {
  return {{"name", result.hard_case.name},
          {"description", result.hard_case.description},
          {"sides", json_list(result.rows, row_to_json)},
          {"hybrid_over_springs_seconds", result.hybrid_over_springs()},
          {"met", result.met()}};
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
    definition.name += " " + expected.model; // names the kept answer
    if (expected.design) {
      definition.msm = {};
      definition.msm.design = *expected.design;
      definition.msm.where = hard_case.msm.where;
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

std::vector<std::string> misses(const cases::Stress& limits, const cases::ExpectedOutcome& expected,
                                const Answer& answer) {
  const cases::Solution& s = answer.solution;
  std::vector<std::string> found;
  if (s.outcome != expected.outcome)
    found.push_back(fmt::format("outcome {}, expected {}", name_of(s.outcome), name_of(expected.outcome)));
  if (expected.load_reached) {
    const auto& [lower, upper] = *expected.load_reached;
    if (!(lower <= s.load_reached && s.load_reached <= upper))
      found.push_back(
          fmt::format("load reached {:.5g} is outside [{:.5g}, {:.5g}]", s.load_reached, lower, upper));
  }
  if (expected.inverted_cells && s.inverted_cells != *expected.inverted_cells)
    found.push_back(
        fmt::format("{} inverted cells, expected {}", s.inverted_cells, *expected.inverted_cells));
  const double seconds = answer.seconds();
  if (!(seconds <= limits.max_seconds))
    found.push_back(fmt::format("{:.1f} s, above the limit of {:.1f} s", seconds, limits.max_seconds));
  if (!(s.newton_iterations <= limits.max_iterations))
    found.push_back(
        fmt::format("{} iterations, above the limit of {}", s.newton_iterations, limits.max_iterations));
  if (!is_finite(s)) found.emplace_back("a result is not finite");
  return found;
}

StressResult judge_stress(const cases::Case& hard_case, int n_threads, const std::vector<Answer>& answers) {
  StressResult result{hard_case, n_threads, {}};
  for (std::size_t r = 0; r < answers.size(); ++r) {
    const cases::ExpectedOutcome& expected = hard_case.stress->expected[r];
    result.rows.push_back({expected, answers[r], misses(*hard_case.stress, expected, answers[r])});
  }
  return result;
}

void write_stress_text(std::ostream& out, const StressResult& result) {
  write_paragraph(out, result.hard_case.name + ": " + result.hard_case.description, "", "  ");
  print(out, "  {:<7}{:<21} {:>7} {:>9} {:>6} {:>11} {:>9} {:>9}\n", "model", "outcome", "load", "residual",
        "iter.", "eig. N/mm", "inverted", "seconds");
  for (const StressRow& row : result.rows) write_row(out, row);
  if (const auto ratio = result.hybrid_over_springs())
    print(out, "  hybrid over springs: {:.2f} x the time ({} thread{})\n", *ratio, result.n_threads,
          result.n_threads == 1 ? "" : "s");
  out.flush();
}

void write_stress_summary(std::ostream& out, const std::vector<StressResult>& results,
                          const std::vector<std::string>& skipped) {
  const auto n_met =
      std::count_if(results.begin(), results.end(), [](const StressResult& r) { return r.met(); });
  print(out, "{} of {} hard cases ended as expected\n", n_met, results.size());
  for (const StressResult& result : results)
    if (!result.met()) print(out, "  DIFFERS: {}\n", result.hard_case.name);
  for (const std::string& name : skipped)
    print(out, "  left out, because it is heavy: {} (--all runs it, or its name)\n", name);
}

Json stress_to_json(const std::vector<StressResult>& results, const std::vector<std::string>& skipped) {
  Json document = provenance();
  document["threads"] = results.empty() ? 1 : results.front().n_threads;
  document["cases"] = json_list(results, result_to_json);
  document["skipped"] = skipped;
  return document;
}

} // namespace springproof::compare
