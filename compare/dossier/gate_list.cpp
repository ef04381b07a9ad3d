#include "compare/dossier/gate_list.hpp"

#include "cases/case/names.hpp"
#include "compare/write/write.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace springproof::compare {

void GateList::add(const Comparison& comparison) {
  const cases::Case& definition = comparison.scene.definition;
  for (const Gate& gate : comparison.gates) {
    const cases::Expectation& expected = gate.expectation;
    const Names others = names_of(definition.name, expected.measure, expected.quantity);
    std::string name = fmt::format("{}{}: {} {}", prefix_, definition.name, expected.measure,
                                   cases::name_of(expected.quantity));
    if (!others.empty()) name += fmt::format(" ({})", others.size() + 1);
    all_.push_back({std::move(name), definition.name, definition.file, gate});
  }
}

GateList::Names GateList::names_of(const std::string& of_case, const std::string& measure) const {
  return names_if(
      [&](const Named& one) { return one.of_case == of_case && one.gate.expectation.measure == measure; });
}

GateList::Names GateList::names_of(const std::string& of_case, const std::string& measure,
                                   cases::Quantity quantity) const {
  return names_if([&](const Named& one) {
    const cases::Expectation& expected = one.gate.expectation;
    return one.of_case == of_case && expected.measure == measure && expected.quantity == quantity;
  });
}

GateList::Names GateList::names_of(cases::ReferenceKind kind) const {
  return names_if([&](const Named& one) { return one.gate.expectation.reference == kind; });
}

Json GateList::to_json() const {
  return json_list(all_, [](const Named& one) -> Json {
    const Gate& gate = one.gate;
    const cases::Expectation& expected = gate.expectation;
    return {{"name", one.name},
            {"case", one.of_case},
            {"file", one.file},
            {"line", expected.where.line},
            {"measure", expected.measure},
            {"quantity", cases::name_of(expected.quantity)},
            {"kind", cases::name_of(expected.reference)},
            {"asserts", expected.reason},
            {"interval", expected.interval},
            {"unit", gate.unit},
            {"value", gate.value},
            {"uncertainty", gate.uncertainty},
            {"met", gate.met()},
            {"judged", !gate.is_left_out},
            {"reason", text_or_null(reason_of(gate))}};
  });
}

void MissingList::add(const std::string& section, const std::string& of_case, const std::string& what,
                      const std::string& filled_by) {
  const Json one{
      {"section", section}, {"case", text_or_null(of_case)}, {"what", what}, {"filled_by", filled_by}};
  if (std::find(all_.begin(), all_.end(), one) == all_.end()) all_.push_back(one);
}

} // namespace springproof::compare
