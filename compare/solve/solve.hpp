#pragma once

#include "compare/provenance/machine.hpp"
#include "compare/solve/answers.hpp"
#include "fem_reference/real_time/real_time.hpp"

#include <functional>
#include <new>

namespace springproof::compare {

/// Solution of a failed solve; of a case that no model can be made of (InputError), refused; where memory is
/// the reason (std::bad_alloc), the message says so.
inline cases::Solution failed_solution(const std::exception& error) {
  if (const auto* solve_error = dynamic_cast<const cases::SolveError*>(&error)) return solve_error->so_far();
  cases::Solution solution;
  solution.status = cases::Status::failed;
  solution.message = dynamic_cast<const std::bad_alloc*>(&error) ? "not enough memory" : error.what();
  if (dynamic_cast<const cases::InputError*>(&error)) solution.outcome = cases::Outcome::refused;
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
  } catch (const std::bad_alloc& error) {
    if (n_mpi_ranks() > 1) throw; // the others wait for this rank
    answer.solution = failed_solution(error);
  }
  answer.solve_seconds = stopwatch.lap();
  return answer;
}

/// Holds reactions against loads where the case asks for no fields, which are checked as they are made.
/// Outside of the measured time: it takes up to a third of a solve. An answer that does not balance is a
/// failed one.
/// @param make_fields  answers the fields of a solution, by the model that has solved it
template<class MakeFields>
void hold_against_loads(const cases::Scene& scene, Answer& answer, const MakeFields& make_fields) {
  if (scene.definition.has_fields || scene.definition.dynamics || !answer.converged()) return;
  try {
    make_fields(answer.solution);
  } catch (const cases::SolveError& error) {
    answer.solution = failed_solution(error);
  }
}

/// Answers on single meshes: finds those that an interrupted command left, keeps the others. Collective.
struct KeptMeshes {
  std::function<std::optional<Answer>(const cases::Fem&)> find = [](const cases::Fem&) {
    return std::nullopt;
  };
  std::function<void(const cases::Fem&, const Answer&)> keep = [](const cases::Fem&, const Answer&) {};
};

/// Solves the finite elements' side, with what "auto" in [fem] leaves open: solve_fem() of
/// compare/error_bars. Its answers are those of solve() without the springs and the peer.
using SolveFem = Answers (*)(const cases::Scene& scene, int n_meshes, const KeptMeshes& kept);

/// How another program answers the finite elements' question: ask_calculix() of compare/peers.
/// @param fem  our answer to the same scene   Collective.
using AskPeer = Peer (*)(const cases::Scene& scene, const Answer& fem);

/// Solves the finite elements with the [fem] of the scene's definition as it is; where that has real_time,
/// solve_stepped_fem(). Collective over MPI_COMM_WORLD.
Answer solve_fem_as_given(const cases::Scene& scene);

/// The finite elements by the method of [fem] real_time, on one rank and one thread: a motion, or where the
/// body comes to rest.
/// @param by  newton: the method's law in a motion whose steps Newton's method solves.   Collective.
Answer solve_stepped_fem(const cases::Scene& scene, fem_reference::StepBy by = fem_reference::StepBy::method,
                         const mechanics::StepLimits& limits = {});

/// The equilibrium that a motion of stepped elements starts in, of dynamics.start = "equilibrium".
/// Collective.
Answer before_stepped_motion(const cases::Scene& scene);

/// The scene with its finite elements solved, without real_time.
cases::Scene with_solved_fem(cases::Scene scene);

/// Why this scene has no continuum limit, such as forces on points, whose displacement grows without bound.
std::optional<std::string> reason_without_continuum_limit(const cases::Scene& scene);

/// The scene with another [fem], such as the one that "auto" was found to mean.
cases::Scene with_fem(cases::Scene scene, const cases::Fem& fem);

/// Solves both sides of a case, or the one asked for, the refined meshes and the peer's side if asked for. A
/// solve that fails is a failed side. Collective over MPI_COMM_WORLD, whose ranks share the solutions; but
/// for solver = "snes", the mass-spring side is solved on rank 0 alone.
/// @throws InputError
Answers solve(const cases::Scene& scene, const Request& request, SolveFem solve_fem,
              const KeptMeshes& kept = {}, AskPeer ask_peer = nullptr);

} // namespace springproof::compare
