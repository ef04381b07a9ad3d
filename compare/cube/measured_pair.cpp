#include "compare/cube/measured_pair.hpp"

#include "compare/measure/measure.hpp"

#include <fmt/format.h>

namespace springproof::compare {

namespace {

const MeasuredValue* find_measure(const Comparison& comparison, const std::string& name) {
  for (const MeasuredValue& measured : comparison.measures)
    if (measured.name == name) return &measured;
  return nullptr;
}

std::string why(const cases::Solution& failed) {
  if (!(failed.load_reached > 0)) return failed.message;
  return fmt::format("{} (reached: {:.2f} of the load)", failed.message, failed.load_reached);
}

} // namespace

MeasuredPair measured_pair(const Comparison& fem, const Comparison& msm, const std::string& measure) {
  const cases::Solution &on_fem = fem.answers.fem.solution, &on_msm = msm.answers.msm.solution;
  if (on_fem.status != cases::Status::converged) return {{}, {}, "finite elements: " + why(on_fem)};
  const MeasuredValue *of_fem = find_measure(fem, measure), *of_msm = find_measure(msm, measure);
  if (!of_fem) return {{}, {}, "the case has no measure " + measure};
  if (on_msm.status != cases::Status::converged) return {of_fem->fem, {}, "springs: " + why(on_msm)};
  return {of_fem->fem, of_msm ? of_msm->msm : std::nullopt, ""};
}

std::optional<double> error_of(const MeasuredPair& pair) {
  return pair.fem && pair.msm ? error_percent(*pair.fem, *pair.msm) : std::nullopt;
}

} // namespace springproof::compare
