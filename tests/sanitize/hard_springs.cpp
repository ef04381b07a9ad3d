// The springs' side of the hard cases named on the command line, without finite elements and MPI: small
// enough to be built with sanitizers whenever the tests run.

#include "cases/case/names.hpp"
#include "cases/case/read_case.hpp"
#include "compare/hard/stress.hpp"
#include "compare/provenance/machine.hpp"
#include "compare/solve/estimate.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"

#include <iostream>

using namespace springproof;

// In place of sources that need the finite elements or MPI: these bodies are small, this process is alone.
cases::Scene compare::make_scene_within_memory(const cases::Case& definition) {
  return cases::make_scene(definition);
}
int compare::n_mpi_ranks() {
  return 1;
}

namespace {

compare::Answer solve(const compare::Question& job) {
  std::optional<msm::DesignResult> design;
  try {
    return compare::solve_springs(job.scene, 1, design);
  } catch (const cases::InputError& error) {
    return {compare::failed_solution(error)};
  }
}

} // namespace

int main(int argc, char** argv) {
  constexpr double slower = 30; // sanitizers and -O1 against -O3: limits of time are for the release build
  int n_missed = 0;
  for (int a = 1; a < argc; ++a) {
    cases::Case hard_case = cases::read_hard_case(argv[a]);
    hard_case.stress->max_seconds *= slower;
    std::vector<compare::Answer> answers(hard_case.stress->expected.size());
    try {
      const std::vector<compare::Question> jobs = compare::jobs_for(hard_case, 1);
      for (std::size_t j = 0; j < jobs.size(); ++j)
        if (jobs[j].request.asks(cases::Side::msm)) answers[j] = solve(jobs[j]);
    } catch (const cases::InputError& error) {
      for (compare::Answer& answer : answers) answer.solution = compare::failed_solution(error);
    }
    for (const auto& [expected, answer, found] : compare::judge_stress(hard_case, 1, answers).rows) {
      if (expected.side == cases::Side::fem) continue;
      std::cout << hard_case.name << ' ' << expected.model << ": " << cases::name_of(answer.solution.outcome)
                << ", " << answer.solve_seconds << " s" << std::endl;
      for (const std::string& miss : found) std::cout << "  DIFFERS: " << miss << '\n';
      n_missed += found.empty() ? 0 : 1;
    }
  }
  return n_missed == 0 ? 0 : 1;
}
