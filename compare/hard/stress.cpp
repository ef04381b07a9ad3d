#include "compare/hard/stress.hpp"

#include "compare/hard/stress_springs.hpp"
#include "compare/provenance/mpi_rank.hpp"
#include "compare/solve/solve_side.hpp"
#include "fem_reference/model.hpp"

#include <algorithm>
#include <mpi.h>

namespace springproof::compare {

namespace {

Answer solve_fem(const cases::HardCase& hard_case) {
  const Stopwatch stopwatch;
  return or_refused([&] {
    const cases::Scene scene = cases::make_scene(hard_case.definition);
    return solve_side([&] { return fem_reference::Model(scene, MPI_COMM_WORLD); },
                      [&](fem_reference::Model& model) {
                        return model.solve(
                            limited_by(hard_case, stopwatch, fem_reference::default_settings()));
                      });
  });
}

const Answer* find(const StressResult& result, cases::Side side) {
  for (const StressRow& row : result.rows)
    if (row.expected.side == side && row.answer.solution.status == cases::Status::converged)
      return &row.answer;
  return nullptr;
}

} // namespace

bool StressResult::met() const {
  return std::all_of(rows.begin(), rows.end(), [](const StressRow& row) { return row.misses.empty(); });
}

std::optional<double> StressResult::hybrid_over_springs() const {
  const Answer *springs = find(*this, cases::Side::msm), *hybrid = find(*this, cases::Side::hybrid);
  if (!springs || !hybrid || !(springs->solve_seconds > 0)) return std::nullopt;
  return hybrid->solve_seconds / springs->solve_seconds;
}

StressResult stress(const cases::HardCase& hard_case, int n_threads) {
  StressResult result;
  result.hard_case = hard_case;
  result.n_threads = n_threads;
  const int rank = mpi_rank();
  for (const cases::ExpectedOutcome& expected : hard_case.expected) {
    const bool is_fem = expected.side == cases::Side::fem;
    if (!is_fem && rank != 0) continue;
    StressRow row{
        expected, is_fem ? solve_fem(hard_case) : solve_springs(expected.side, hard_case, n_threads), {}};
    row.misses = misses(hard_case, expected, row.answer);
    result.rows.push_back(std::move(row));
  }
  return result;
}

} // namespace springproof::compare
