#pragma once

#include "compare/solve/answers.hpp"

#include <nlohmann/json_fwd.hpp>
#include <ostream>
#include <string>
#include <vector>

/// Hard cases: the jobs that they are solved by, what became of each model, held against what must, and its
/// report.
namespace springproof::compare {

/// One model's way through a hard case.
struct StressRow {
  cases::ExpectedOutcome expected;
  Answer answer;                   ///< its solution has an outcome even when it failed
  std::vector<std::string> misses; ///< what differs from what was expected; empty: nothing
};

struct StressResult {
  cases::Case hard_case;
  int n_threads = 1;
  std::vector<StressRow> rows;
  bool met() const; ///< no row misses anything
  /// Solve time of the hybrid lattice over that of the springs, where both found an equilibrium.
  std::optional<double> hybrid_over_springs() const;
};

/// A question for each model that a hard case expects something of, named after case and model.
/// @param n_threads  used by the springs' multigrid path
/// @throws InputError when no scene can be made of the case
std::vector<Question> jobs_for(const cases::Case& hard_case, int n_threads);

/// What a model's answer to a hard case differs in from what is expected of it and from the case's limits;
/// empty: nothing.
std::vector<std::string> misses(const cases::Stress& limits, const cases::ExpectedOutcome& expected,
                                const Answer& answer);

/// Holds the answers to a hard case's jobs, in their order, against what it expects.
StressResult judge_stress(const cases::Case& hard_case, int n_threads, const std::vector<Answer>& answers);

/// A case's name and sentence, one line per model, and what differs.
void write_stress_text(std::ostream& out, const StressResult& result);

/// Which cases were left out, and how many of the others ended as expected.
/// @param skipped  names of heavy cases that were not asked for
void write_stress_summary(std::ostream& out, const std::vector<StressResult>& results,
                          const std::vector<std::string>& skipped);

/// The document of `stress --json`.
nlohmann::ordered_json stress_to_json(const std::vector<StressResult>& results,
                                      const std::vector<std::string>& skipped);

} // namespace springproof::compare
