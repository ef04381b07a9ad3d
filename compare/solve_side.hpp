#pragma once

#include "compare/comparison.hpp"
#include "compare/stopwatch.hpp"

namespace compare {

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
    side.solution = {};
    side.solution.status = cases::Status::failed;
    side.solution.message = error.what();
    side.solution.outcome = error.outcome();
    side.solution.load_reached = error.load_reached();
    side.solution.residual = error.residual();
    side.solution.newton_iterations = error.progress().newton_iterations;
    side.solution.lowest_eigenvalue = error.progress().lowest_eigenvalue;
    side.solution.inverted_cells = error.progress().inverted_cells;
  }
  side.solve_seconds = stopwatch.lap();
  return side;
}

} // namespace compare
