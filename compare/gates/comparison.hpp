#pragma once

#include "compare/gates/judge.hpp"
#include "compare/measure/landmarks.hpp"
#include "compare/measure/surface_motion.hpp"

namespace springproof::compare {

/// All that is known of a case after it was solved: one read-only record, which the writers read. Made by
/// comparison_of() alone.
struct Comparison {
  cases::Scene scene; ///< as the case file has it; what "auto" was found to mean is with the answers
  Answers answers;
  std::vector<MeasuredValue> measures;
  std::vector<Gate> gates;                     ///< one per expectation
  std::optional<MeshStudy> mesh_study;         ///< absent when the case has accuracy = "none"
  std::vector<LandmarkDistance> landmarks;     ///< one per landmark
  std::optional<SurfaceMotion> surface_motion; ///< of a dynamic case with a [surface]

  /// What a converged side must not be unless its case accepts that: with inverted cells, or in an unstable
  /// equilibrium.
  std::vector<std::string> doubts() const;
  /// What failed of the case as a whole: it expects nothing, a solve failed or is in doubt.
  std::vector<std::string> failures() const;
  /// No solve failed or is in doubt, and no gate is missed; those that need a side that was not asked for are
  /// not judged: the success of `run`.
  bool is_sound() const;
  /// The success of `gate`. Never met are: an expectation of a measure that is not there, or has no finite
  /// value; a case that expects nothing; a case of which a solve has failed or is in doubt.
  bool met() const;
};

/// Measures the answers to a case, and judges its expectations by that.
Comparison comparison_of(cases::Scene scene, Answers answers);

/// Solves a case in this process and compares. Collective over MPI_COMM_WORLD.  @throws InputError
Comparison compare_case(const cases::Case& definition, const Request& request = {});

bool all_met(const std::vector<Comparison>& cases);

} // namespace springproof::compare
