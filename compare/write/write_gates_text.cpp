#include "compare/write/write_gates.hpp"

#include "cases/case/names.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

void write_line(std::ostream& out, bool met, const std::string& kind, const std::string& name,
                const std::string& what) {
  fmt::print(out, "{} {:<10} {}: {}\n", met ? "met   " : "FAILED", kind, name, what);
}

} // namespace

std::vector<GateCount> count_by_kind(const std::vector<GatedCase>& cases) {
  std::vector<GateCount> counts;
  for (const auto& [kind, name] : cases::names<cases::ReferenceKind>()) {
    GateCount count{kind};
    for (const GatedCase& judged : cases)
      for (const Gate& gate : judged.gates) {
        if (gate.judgement.expectation.reference != kind) continue;
        ++count.all;
        if (gate.met()) ++count.met;
      }
    if (count.all > 0) counts.push_back(count);
  }
  return counts;
}

void write_gates_text(std::ostream& out, const std::vector<GatedCase>& cases) {
  for (const GatedCase& judged : cases) {
    for (const std::string& failure : judged.failures) write_line(out, false, "case", judged.name, failure);
    for (const Gate& gate : judged.gates) {
      write_line(out, gate.met(), cases::name_of(gate.judgement.expectation.reference), judged.name,
                 describe(gate) + describe_uncertainty(gate));
      if (!gate.warning.empty()) fmt::print(out, "       warning: {}\n", gate.warning);
    }
  }
  std::string counts;
  for (const GateCount& count : count_by_kind(cases))
    counts += fmt::format("{}{} {} of {}", counts.empty() ? "" : ", ", cases::name_of(count.kind), count.met,
                          count.all);
  fmt::print(out, "{}: {}\n", all_met(cases) ? "all gates met" : "GATES FAILED",
             counts.empty() ? "there are none" : counts);
}

} // namespace springproof::compare
