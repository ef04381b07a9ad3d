#pragma once

#include "compare/provenance/stopwatch.hpp"
#include "compare/solve/comparison.hpp"

namespace springproof::compare {

/// What is known of a solve that failed.
inline cases::Solution failed_solution(const cases::SolveError& error) {
  cases::Solution solution;
  solution.status = cases::Status::failed;
  solution.message = error.what();
  solution.outcome = error.outcome();
  solution.load_reached = error.load_reached();
  solution.residual = error.residual();
  solution.newton_iterations = error.progress().newton_iterations;
  solution.lowest_eigenvalue = error.progress().lowest_eigenvalue;
  solution.inverted_cells = error.progress().inverted_cells;
  return solution;
}

/// Builds a model and solves it; both sides have the same two steps. A solve that fails is a failed side.
/// @param make_model  answers a model   @param solve  answers the model's solution
template<class MakeModel, class Solve>
Side solve_side(const MakeModel& make_model, const Solve& solve) {
  Side side;
  Stopwatch stopwatch;
  try {
    auto model = make_model();
    side.setup_seconds = stopwatch.lap();
    side.solution = solve(model);
  } catch (const cases::SolveError& error) {
    side.solution = failed_solution(error);
  }
  side.solve_seconds = stopwatch.lap();
  return side;
}

} // namespace springproof::compare
