#include "compare/write/write_gates.hpp"

#include "cases/case/names.hpp"
#include "compare/write/json.hpp"
#include "compare/write/write.hpp"

namespace springproof::compare {

using Json = nlohmann::ordered_json;

namespace {

Json gate_to_json(const GatedCase& judged, const Gate& gate) {
  const cases::Expectation& expected = gate.judgement.expectation;
  return {{"case", judged.name},
          {"file", judged.file},
          {"line", expected.where.line},
          {"reference", cases::name_of(expected.reference)},
          {"measure", expected.measure},
          {"quantity", cases::name_of(expected.quantity)},
          {"unit", gate.unit},
          {"interval", expected.interval},
          {"interval_reason", expected.reason},
          {"value", gate.judgement.value},
          {"reference_uncertainty", gate.uncertainty},
          {"met", gate.met()},
          {"reason", reason_of(gate)},
          {"warning", gate.warning}};
}

} // namespace

Json gates_to_json(const std::vector<GatedCase>& cases) {
  Json document = provenance();
  document["gates"] = Json::array();
  document["failures"] = Json::array();
  document["kinds"] = Json::object();
  for (const GatedCase& judged : cases) {
    for (const Gate& gate : judged.gates) document["gates"].push_back(gate_to_json(judged, gate));
    for (const std::string& failure : judged.failures)
      document["failures"].push_back({{"case", judged.name}, {"file", judged.file}, {"reason", failure}});
  }
  for (const GateCount& count : count_by_kind(cases))
    document["kinds"][cases::name_of(count.kind)] = {{"met", count.met}, {"all", count.all}};
  document["met"] = all_met(cases);
  return document;
}

} // namespace springproof::compare
