#pragma once

#include "cases/case/hard_case.hpp"
#include "compare/solve/answers.hpp"

#include <string>
#include <vector>

/// Hard cases: what became of each model, held against what must.
namespace springproof::compare {

/// One model's way through a hard case.
struct StressRow {
  cases::ExpectedOutcome expected;
  Answer answer;                   ///< its solution has an outcome even when it failed
  std::vector<std::string> misses; ///< what differs from what was expected; empty: nothing
};

struct StressResult {
  cases::HardCase hard_case;
  int n_threads = 1;
  std::vector<StressRow> rows;
  bool met() const; ///< no row misses anything
  /// Solve time of the hybrid lattice over that of the springs, where both found an equilibrium.
  std::optional<double> hybrid_over_springs() const;
};

/// Puts a hard case to every model that it expects something of. A model that fails is a row with its reason.
/// Collective over MPI_COMM_WORLD; springs are solved on rank 0 alone, where alone the answer is whole.
/// @param n_threads  of the springs' multigrid path
StressResult stress(const cases::HardCase& hard_case, int n_threads);

} // namespace springproof::compare
