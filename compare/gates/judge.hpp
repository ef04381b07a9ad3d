#pragma once

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

/// @param measures  of the same case
Judgement judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures);

} // namespace springproof::compare
