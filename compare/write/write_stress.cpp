#include "compare/write/write_stress.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/paragraph.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/json.hpp"
#include "compare/write/write.hpp"

#include <algorithm>

namespace springproof::compare {

namespace {

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

} // namespace

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
  document["cases"] = Json::array();
  for (const StressResult& result : results) {
    Json sides = Json::array();
    for (const StressRow& row : result.rows) sides.push_back(row_to_json(row));
    const auto ratio = result.hybrid_over_springs();
    document["cases"].push_back({{"name", result.hard_case.name},
                                 {"description", result.hard_case.description},
                                 {"sides", sides},
                                 {"hybrid_over_springs_seconds", ratio},
                                 {"met", result.met()}});
  }
  document["skipped"] = skipped;
  return document;
}

} // namespace springproof::compare
