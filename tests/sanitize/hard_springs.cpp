// The springs' side of the hard cases named on the command line, without finite elements and MPI: small
// enough to be built with sanitizers whenever the tests run.

#include "compare/hard/stress_springs.hpp"

#include <iostream>

using namespace springproof;

int main(int argc, char** argv) {
  constexpr double slower = 30; // sanitizers and -O1 against -O3: limits of time are for the release build
  int n_missed = 0;
  for (int a = 1; a < argc; ++a) {
    cases::HardCase hard_case = cases::read_hard_case(argv[a]);
    hard_case.max_seconds *= slower;
    for (const cases::ExpectedOutcome& expected : hard_case.expected) {
      if (expected.side == cases::Side::fem) continue;
      const compare::Answer side = compare::solve_springs(expected.side, hard_case, 1);
      const std::vector<std::string> found = compare::misses(hard_case, expected, side);
      std::cout << hard_case.definition.name << ' ' << cases::name_of(expected.side) << ": "
                << cases::name_of(side.solution.outcome) << ", " << side.solve_seconds << " s" << std::endl;
      for (const std::string& miss : found) std::cout << "  DIFFERS: " << miss << '\n';
      n_missed += found.empty() ? 0 : 1;
    }
  }
  return n_missed == 0 ? 0 : 1;
}
