#pragma once

#include "compare/provenance/stopwatch.hpp"
#include "compare/solve/answers.hpp"

namespace springproof::compare {

/// Solution of a failed solve.
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

/// Solution of a case that no model can be made of.
inline cases::Solution failed_solution(const cases::InputError& error) {
  cases::Solution solution;
  solution.status = cases::Status::failed;
  solution.message = error.what();
  solution.outcome = cases::Outcome::refused;
  return solution;
}

/// Builds a model and solves it; both sides have the same two steps. A solve that fails is a failed answer.
/// @param make_model  answers a model   @param solve  answers the model's solution
template<class MakeModel, class Solve>
Answer solve_side(const MakeModel& make_model, const Solve& solve) {
  Answer answer;
  Stopwatch stopwatch;
  try {
    auto model = make_model();
    answer.setup_seconds = stopwatch.lap();
    answer.solution = solve(model);
  } catch (const cases::SolveError& error) {
    answer.solution = failed_solution(error);
  }
  answer.solve_seconds = stopwatch.lap();
  return answer;
}

} // namespace springproof::compare
