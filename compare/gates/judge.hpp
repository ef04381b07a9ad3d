#pragma once

#include "compare/error_bars/measured_values.hpp"
#include "compare/measure/measure.hpp"

namespace springproof::compare {

/// An expectation held against what was measured, and what the reader of the verdict must know besides. What
/// cannot be measured is missed, with the reason.
struct Gate {
  cases::Expectation expectation;
  std::optional<double> value;
  std::string missed{}; ///< why it is not met; empty when it is
  std::string unit{};   ///< of the interval and the value: "%", "mm", "deg", "mm3"
  /// Half the width of the reference's own error bar from its mesh study, in the unit. A gate against a
  /// converged reference is met when all of value -+ uncertainty is inside; for others it is shown alone.
  /// Absent where there is none, and for the springs' own value, which has no reference. Of results that were
  /// interpolated it has what that may add, and every gate must be met by all of value -+ uncertainty.
  std::optional<double> uncertainty{};
  std::string uncertain = "reference"; ///< what the uncertainty is of
  bool is_undecided = false;           ///< not met, because the interval's end lies within the uncertainty
  std::string warning{}; ///< such as that the interval is narrower than the error bar; empty: none
  std::string cause{};   ///< why a measure that is there has no value; empty when it has one
  /// Without a value because a side that it needs was not asked for: neither met nor missed. `gate` is not
  /// met by it.
  bool is_left_out = false;
  bool met() const { return missed.empty(); }
};

/// By what was measured alone. Of a converged reference the finite elements' value is their limit.
/// @param measures  of the same case
Gate judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures);

/// Judges every expectation of a case by what was measured.
/// @param study  null: there is none
std::vector<Gate> judge(const cases::Scene& scene, const Answers& answers,
                        const std::vector<MeasuredValue>& measures, const MeshStudy* study);

/// What a model's answer to a hard case differs in from what is expected of it and from the case's limits;
/// empty: nothing.
std::vector<std::string> misses(const cases::Stress& limits, const cases::ExpectedOutcome& expected,
                                const Answer& answer);

/// "fem failed at 0.25 of the load: REASON"
std::string describe_failure(const char* side, const cases::Solution& solution);

} // namespace springproof::compare
