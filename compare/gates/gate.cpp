#include "compare/gates/gate.hpp"

#include "cases/case/names.hpp"
#include "compare/measure/measure.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

using cases::Quantity;

template<class Named>
const Named* find(const std::vector<Named>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const Named& n) { return n.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const StudiedMeasure* studied(const Comparison& comparison, const std::string& measure) {
  return comparison.mesh_study ? find(comparison.mesh_study->measures, measure) : nullptr;
}

/// What judge() cannot know from the measures alone.
std::string why_without_value(const Comparison& comparison, Quantity quantity) {
  const auto why = [](const char* side, const cases::Solution& solution) -> std::string {
    if (solution.status == cases::Status::skipped) return fmt::format("{} was not solved", side);
    if (solution.status == cases::Status::converged) return "";
    return fmt::format("{} failed at {:.4g} of the load: {}", side, solution.load_reached, solution.message);
  };
  std::string reason;
  if (quantity != Quantity::msm) reason = why("fem", comparison.answers.fem.solution);
  if (quantity != Quantity::fem && reason.empty()) reason = why("msm", comparison.answers.msm.solution);
  return reason.empty() ? "it has no finite value" : reason;
}

/// From an error bar of d percent of the finite elements' value f: d f/100 of f itself; of r = 100 (m/f - 1),
/// to first order in d, (100 + r) d/100 points. The error of a field norm is of a difference of fields, of
/// which the bar of the norm says nothing.
std::optional<double> uncertainty(const Comparison& comparison, const Judgement& judgement) {
  const cases::Expectation& expected = judgement.expectation;
  const StudiedMeasure* study = studied(comparison, expected.measure);
  const cases::Measure* measure = find(comparison.scene.definition.measures, expected.measure);
  if (!study || !measure || !study->discretisation_error_percent || !judgement.value) return std::nullopt;
  const double part = *study->discretisation_error_percent / 100;
  switch (expected.quantity) {
  case Quantity::fem:
    return part * std::abs(*judgement.value);
  case Quantity::error_percent:
    if (is_field_norm(measure->kind)) return std::nullopt;
    return part * std::abs(100 + *judgement.value);
  case Quantity::msm:
    break;
  }
  return std::nullopt;
}

std::string warning_of(const Comparison& comparison, const Gate& gate) {
  const cases::Expectation& expected = gate.judgement.expectation;
  const double width = expected.interval[1] - expected.interval[0];
  if (gate.uncertainty && !(width >= 2 * *gate.uncertainty))
    return fmt::format("the interval is narrower than the reference's own error bar, +- {:.2g} {}",
                       *gate.uncertainty, gate.unit);
  if (expected.reference != cases::ReferenceKind::converged || gate.uncertainty ||
      expected.quantity == Quantity::msm || !gate.judgement.value)
    return "";
  const StudiedMeasure* study = studied(comparison, expected.measure);
  return "the reference has no error bar" + (study && !study->reason.empty() ? ": " + study->reason : "");
}

std::string gated_unit(const Comparison& comparison, const cases::Expectation& expected) {
  if (expected.quantity == Quantity::error_percent) return "%";
  const cases::Measure* measure = find(comparison.scene.definition.measures, expected.measure);
  return measure ? unit_of(*measure) : "";
}

Gate make_gate(const Comparison& comparison, const cases::Expectation& expected) {
  Gate gate{judge(expected, comparison.measures), gated_unit(comparison, expected), std::nullopt, ""};
  const MeasuredValue* measured = find(comparison.measures, expected.measure);
  if (measured && !gate.met() && !gate.judgement.value)
    gate.judgement.reason = why_without_value(comparison, expected.quantity);
  gate.uncertainty = uncertainty(comparison, gate.judgement);
  gate.warning = warning_of(comparison, gate);
  return gate;
}

void add_failure(GatedCase& judged, const char* side, const cases::Solution& solution) {
  if (solution.status != cases::Status::failed) return;
  judged.failures.push_back(
      fmt::format("{} failed at {:.4g} of the load: {}", side, solution.load_reached, solution.message));
}

} // namespace

bool GatedCase::met() const {
  return failures.empty() &&
         std::all_of(gates.begin(), gates.end(), [](const Gate& gate) { return gate.met(); });
}

bool all_met(const std::vector<GatedCase>& cases) {
  return std::all_of(cases.begin(), cases.end(), [](const GatedCase& c) { return c.met(); });
}

bool asks_for_mesh_study(const cases::Case& definition) {
  return std::any_of(
      definition.expectations.begin(), definition.expectations.end(), [](const auto& expected) {
        return expected.reference == cases::ReferenceKind::converged && expected.quantity != Quantity::msm;
      });
}

GatedCase judge_gates(const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  GatedCase judged{definition.name, definition.file, {}, {}};
  for (const cases::Expectation& expected : definition.expectations)
    judged.gates.push_back(make_gate(comparison, expected));
  if (judged.gates.empty()) judged.failures.push_back("it expects nothing: there is no [[expect]]");
  add_failure(judged, "fem", comparison.answers.fem.solution);
  add_failure(judged, "msm", comparison.answers.msm.solution);
  return judged;
}

std::string describe(const Gate& gate) {
  const cases::Expectation& expected = gate.judgement.expectation;
  std::string text = fmt::format("{} {}", expected.measure, cases::name_of(expected.quantity));
  if (gate.judgement.value)
    text += fmt::format(" = {:.9g} {}, {} [{}, {}]", *gate.judgement.value, gate.unit,
                        gate.met() ? "in" : "not in", expected.interval[0], expected.interval[1]);
  else
    text += ": " + gate.judgement.reason;
  return text;
}

std::string describe_uncertainty(const Gate& gate) {
  return gate.uncertainty ? fmt::format(" (reference +- {:.2g} {})", *gate.uncertainty, gate.unit) : "";
}

} // namespace springproof::compare
