#include "compare/thesis/measured_pair.hpp"

#include "compare/measure.hpp"

namespace compare {

namespace {

const MeasuredValue* find_measure(const Comparison& comparison, const std::string& name) {
  for (const MeasuredValue& measured : comparison.measures)
    if (measured.name == name) return &measured;
  return nullptr;
}

} // namespace

MeasuredPair measured_pair(const Comparison& fem, const Comparison& msm, const std::string& measure) {
  const MeasuredValue *on_fem = find_measure(fem, measure), *on_msm = find_measure(msm, measure);
  if (!on_fem || !on_msm) return {std::nullopt, std::nullopt, "the case has no measure " + measure};
  MeasuredPair pair{on_fem->fem, on_msm->msm, ""};
  if (!pair.fem)
    pair.reason = "finite elements: " + fem.fem.solution.message;
  else if (!pair.msm)
    pair.reason = "springs: " + msm.msm.solution.message;
  return pair;
}

std::optional<double> error_of(const MeasuredPair& pair) {
  return pair.fem && pair.msm ? error_percent(*pair.fem, *pair.msm) : std::nullopt;
}

} // namespace compare
