#include "compare/gates/judge.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

Judgement judge(const cases::Expectation& expectation, const std::vector<MeasuredValue>& measures) {
  const auto found = std::find_if(measures.begin(), measures.end(),
                                  [&](const MeasuredValue& m) { return m.name == expectation.measure; });
  if (found == measures.end())
    return {expectation, Verdict::missed, std::nullopt, "there is no such measure"};
  std::optional<double> value;
  switch (expectation.quantity) {
  case cases::Quantity::error_percent:
    value = found->error_percent;
    break;
  case cases::Quantity::msm:
    value = found->msm;
    break;
  case cases::Quantity::fem:
    value = found->fem;
    break;
  }
  if (!value)
    return {expectation, Verdict::missed, value, "it has no value: a side failed or was not solved"};
  if (!std::isfinite(*value))
    return {expectation, Verdict::missed, std::nullopt, "it is not a finite number"};
  if (expectation.interval[0] <= *value && *value <= expectation.interval[1])
    return {expectation, Verdict::met, value, ""};
  return {expectation, Verdict::missed, value,
          fmt::format("{:.6g} is outside [{:.6g}, {:.6g}]", *value, expectation.interval[0],
                      expectation.interval[1])};
}

} // namespace springproof::compare
