#pragma once

#include "compare/error_bars/measured_values.hpp"
#include "compare/measure/measure.hpp"
#include "compare/measure/surfaces.hpp"

namespace springproof::compare {

/// An expectation held against what was measured, and what the reader of the verdict must know besides. What
/// cannot be measured is missed, with the reason.
struct Gate {
  cases::Expectation expectation;
  std::optional<double> value;
  std::string missed{}; ///< why it is not met; empty when it is
  std::string unit{};   ///< unit of interval and value: "%", "mm", "deg", "mm3"
  /// Half the width of the reference's own error bar from its mesh study, in the unit. A gate against a
  /// converged reference is met when all of value -+ uncertainty is inside; for others it is shown alone.
  /// Absent where there is none, and for the springs' own value, which has no reference. It includes what
  /// interpolation of results may add, and then every gate must be met by all of value -+ uncertainty.
  std::optional<double> uncertainty{};
  std::string uncertain = "reference"; ///< what the uncertainty is of
  bool is_undecided = false;           ///< not met, because the interval's end lies within the uncertainty
  std::string warning{}; ///< such as that the interval is narrower than the error bar; empty: none
  std::string cause{};   ///< why a measure that is there has no value; empty when it has one
  /// True when a side that it needs was not asked for: it has no value and is neither met nor missed. `gate`
  /// is not met by it.
  bool is_left_out = false;
  bool met() const { return missed.empty(); }
};

/// Judges every expectation of a case by what was measured.
/// @param study  null: there is none
std::vector<Gate> judge(const cases::Scene& scene, const Answers& answers,
                        const std::vector<MeasuredValue>& measures, const MeshStudy* study);

/// All that is known of a case after it was solved: one read-only record, which the writers read. Made by
/// comparison_of() alone.
struct Comparison {
  cases::Scene scene; ///< as the case file has it; what "auto" was found to mean is with the answers
  Answers answers;
  std::vector<MeasuredValue> measures;
  std::vector<Gate> gates;                     ///< one per expectation
  std::optional<MeshStudy> mesh_study;         ///< absent when the case has accuracy = "none"
  std::vector<LandmarkDistance> landmarks;     ///< one per landmark
  std::optional<SurfaceMotion> surface_motion; ///< present for a dynamic case with a [surface]

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
