#pragma once

#include "compare/error_bars/mesh_study.hpp"
#include "compare/measure/measured_values.hpp"

namespace springproof::compare {

enum class Verdict { met, missed };

/// An expectation held against what was measured. What cannot be measured is missed, with the reason.
struct Judgement {
  cases::Expectation expectation;
  Verdict verdict;
  std::optional<double> value;
  std::string reason; ///< empty when met
};

/// An expectation of a case, judged, and what the reader of the verdict must know besides.
struct Gate {
  Judgement judgement;
  std::string unit; ///< of the interval and the value: "%", "mm", "deg", "mm3"
  /// Half the width of the reference's own error bar from its mesh study, in the unit: shown, and added to
  /// neither side. Absent where there is none, and for the springs' own value, which has no reference.
  std::optional<double> uncertainty;
  std::string warning; ///< such as that the interval is narrower than the error bar; empty: none
  std::string cause;   ///< why a measure that is there has no value; empty when it has one
  bool met() const { return judgement.verdict == Verdict::met; }
};

/// By the values alone.  @param measures  of the same case
Judgement judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures);

/// Judges every expectation of a case by what was measured.
/// @param study  null: there is none
std::vector<Gate> judge(const cases::Scene& scene, const Answers& answers,
                        const std::vector<MeasuredValue>& measures, const MeshStudy* study);

/// What a model's answer to a hard case differs in from what is expected of it and from the case's limits;
/// empty: nothing.
std::vector<std::string> misses(const cases::Stress& limits, const cases::ExpectedOutcome& expected,
                                const Answer& answer);

} // namespace springproof::compare
