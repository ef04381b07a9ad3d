#include "compare/gates/gate.hpp"

#include "cases/case/names.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

namespace {

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
  return std::any_of(definition.expectations.begin(), definition.expectations.end(),
                     [](const auto& expected) {
                       return expected.reference == cases::ReferenceKind::converged &&
                              expected.quantity != cases::Quantity::msm;
                     });
}

GatedCase judge_gates(const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  GatedCase judged{definition.name, definition.file, comparison.gates, {}};
  if (judged.gates.empty()) judged.failures.push_back("it expects nothing: there is no [[expect]]");
  add_failure(judged, "fem", comparison.answers.fem.solution);
  add_failure(judged, "msm", comparison.answers.msm.solution);
  return judged;
}

std::string reason_of(const Gate& gate) {
  return gate.cause.empty() ? gate.judgement.reason : gate.cause;
}

std::string describe(const Gate& gate) {
  const cases::Expectation& expected = gate.judgement.expectation;
  std::string text = fmt::format("{} {}", expected.measure, cases::name_of(expected.quantity));
  if (gate.judgement.value)
    text += fmt::format(" = {:.9g} {}, {} [{}, {}]", *gate.judgement.value, gate.unit,
                        gate.met() ? "in" : "not in", expected.interval[0], expected.interval[1]);
  else
    text += ": " + reason_of(gate);
  return text;
}

std::string describe_uncertainty(const Gate& gate) {
  return gate.uncertainty ? fmt::format(" (reference +- {:.2g} {})", *gate.uncertainty, gate.unit) : "";
}

} // namespace springproof::compare
