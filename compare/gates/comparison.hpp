#pragma once

#include "compare/error_bars/mesh_study.hpp"
#include "compare/gates/judge.hpp"

namespace springproof::compare {

/// All that is known of a case after it was solved: one read-only record, which the writers read. Made by
/// comparison_of() alone.
struct Comparison {
  cases::Scene scene; ///< as the case file has it; what "auto" was found to mean is with the answers
  Answers answers;
  std::vector<MeasuredValue> measures;
  std::vector<Gate> gates;             ///< one per expectation
  std::optional<MeshStudy> mesh_study; ///< when asked for
};

/// Measures the answers to a case, and judges its expectations by that.
Comparison comparison_of(cases::Scene scene, Answers answers);

/// Solves a case in this process and compares. Collective over MPI_COMM_WORLD.  @throws InputError
Comparison compare_case(const cases::Case& definition, const Request& request = {});

} // namespace springproof::compare
