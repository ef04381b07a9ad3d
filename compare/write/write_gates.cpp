#include "compare/write/write.hpp"

#include "cases/case/names.hpp"
#include "compare/provenance/print.hpp"
#include "compare/table/table.hpp"
#include "compare/write/quote.hpp"

#include <algorithm>
#include <fmt/ranges.h>

namespace springproof::compare {

namespace {

/// How many gates of a kind there are, and how many are met.
struct GateCount {
  cases::ReferenceKind kind;
  int met = 0, all = 0;
};

/// Counts the kinds that occur, in the order of their table.
std::vector<GateCount> count_by_kind(const std::vector<Comparison>& cases) {
  std::vector<GateCount> counts;
  for (const std::string& name : cases::all_names<cases::ReferenceKind>()) {
    GateCount count{*cases::value_of<cases::ReferenceKind>(name)};
    for (const Comparison& judged : cases)
      for (const Gate& gate : judged.gates) {
        if (gate.expectation.reference != count.kind) continue;
        ++count.all;
        if (gate.met()) ++count.met;
      }
    if (count.all > 0) counts.push_back(count);
  }
  return counts;
}

/// The error bar in words, " (reference +- 0.21 %)", or nothing.
std::string describe_uncertainty(const Gate& gate) {
  return gate.uncertainty ? fmt::format(" ({} +- {:.2g} {})", gate.uncertain, *gate.uncertainty, gate.unit)
                          : "";
}

void write_line(std::ostream& out, bool met, const std::string& kind, const std::string& name,
                const std::string& what) {
  print(out, "{} {:<11} {}: {}\n", met ? "met   " : "FAILED", kind, name, what);
}

std::string in_xml(const std::string& text) {
  return escape(one_line(text));
}

/// A test suite of JUnit's.
struct TestSuite {
  std::string name;
  std::string tests{}; ///< as XML
  int n = 0, n_failures = 0, n_errors = 0;

  /// @param element  "failure" or "error"; empty: passed    @param output  lines that a server shows besides
  void add(const std::string& test, const std::string& of_case, const std::string& element,
           const std::string& message, const std::vector<std::string>& output) {
    ++n;
    n_failures += element == "failure";
    n_errors += element == "error";
    tests += fmt::format("    <testcase name=\"{}\" classname=\"{}\">\n", in_xml(test), in_xml(of_case));
    if (!element.empty())
      tests += fmt::format("      <{0} message=\"{1}\" type=\"{0}\">{1}</{0}>\n", element, in_xml(message));
    if (!output.empty()) {
      tests += "      <system-out>";
      for (const std::string& line : output) tests += in_xml(line) + "\n";
      tests += "</system-out>\n";
    }
    tests += "    </testcase>\n";
  }
  void add(const Comparison& judged, const Gate& gate) {
    const cases::Expectation& expected = gate.expectation;
    std::vector<std::string> output{describe(gate) + describe_uncertainty(gate),
                                    "interval: " + expected.reason};
    if (!gate.warning.empty()) output.push_back("warning: " + gate.warning);
    add(fmt::format("{} {} in [{}, {}]", expected.measure, cases::name_of(expected.quantity),
                    expected.interval[0], expected.interval[1]),
        judged.scene.definition.name,
        gate.met()   ? ""
        : gate.value ? "failure"
                     : "error",
        describe(gate), output);
  }
  std::string counts() const {
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", n, n_failures, n_errors);
  }
};

/// Suites are named after kinds, a suite for what failed as a whole first; empty ones are left out.
std::vector<TestSuite> make_suites(const std::vector<Comparison>& cases) {
  std::vector<TestSuite> suites{{"springproof.cases"}};
  for (const Comparison& judged : cases) {
    int n = 0; // failures of the case so far
    for (const std::string& failure : judged.failures())
      suites.front().add("solved and judged" + (n++ == 0 ? "" : fmt::format(" ({})", n)),
                         judged.scene.definition.name, "error", failure, {});
  }
  if (suites.front().n == 0) suites.clear();
  for (const GateCount& count : count_by_kind(cases)) {
    suites.push_back({"springproof." + cases::name_of(count.kind)});
    for (const Comparison& judged : cases)
      for (const Gate& gate : judged.gates)
        if (gate.expectation.reference == count.kind) suites.back().add(judged, gate);
  }
  return suites;
}

/// GitHub's escapes: in values of properties a colon and a comma would end them too.
std::string in_annotation(const std::string& text, const std::string& special) {
  std::string result;
  for (const char c : text)
    result += special.find(c) == std::string::npos ? std::string(1, c) : fmt::format("%{:02X}", int{c});
  return result;
}

void annotate(std::ostream& out, const char* level, const std::string& file, int line,
              const std::string& title, const std::string& message) {
  const std::string in_message = "%\r\n", in_property = "%\r\n:,";
  print(out, "::{} file={},line={},title={}::{}\n", level, in_annotation(file, in_property), line,
        in_annotation(title, in_property), in_annotation(message, in_message));
}

Json gate_to_json(const Gate& gate) {
  const cases::Expectation& expected = gate.expectation;
  return {{"measure", expected.measure},   {"quantity", cases::name_of(expected.quantity)},
          {"interval", expected.interval}, {"reference", cases::name_of(expected.reference)},
          {"value", gate.value},           {"met", gate.met()},
          {"judged", !gate.is_left_out},   {"undecided", gate.is_undecided},
          {"reason", reason_of(gate)}};
}

Json gate_of_case_to_json(const Comparison& judged, const Gate& gate) {
  Json row{{"case", judged.scene.definition.name},
           {"file", judged.scene.definition.file},
           {"line", gate.expectation.where.line}};
  row.update(gate_to_json(gate));
  row.update({{"unit", gate.unit},
              {"interval_reason", gate.expectation.reason},
              {"reference_uncertainty", gate.uncertainty},
              {"warning", gate.warning}});
  return row;
}

} // namespace

std::string reason_of(const Gate& gate) {
  return gate.cause.empty() ? gate.missed : gate.cause;
}

std::string describe(const Gate& gate) {
  const cases::Expectation& expected = gate.expectation;
  const std::string what = fmt::format("{} {}", expected.measure, cases::name_of(expected.quantity));
  if (!gate.value) return what + ": " + reason_of(gate);
  // An undecided gate, or one without the reference that it asks for, says so in its reason.
  const bool is_inside = expected.interval[0] <= *gate.value && *gate.value <= expected.interval[1];
  if (gate.is_undecided || (is_inside && !gate.met())) return what + ": " + gate.missed;
  return what + fmt::format(" = {:.9g} {}, {} [{}, {}]", *gate.value, gate.unit, gate.met() ? "in" : "not in",
                            expected.interval[0], expected.interval[1]);
}

void write_expectations_text(std::ostream& out, const std::vector<Gate>& gates) {
  const auto n_met = std::count_if(gates.begin(), gates.end(), [](const Gate& gate) { return gate.met(); });
  if (n_met > 0) print(out, "  met    {} of {} expectations\n", n_met, gates.size());
  for (const Gate& gate : gates) {
    if (gate.met()) continue;
    write_wrapped(out,
                  fmt::format("  {} {} {} ({}): {}", gate.is_left_out ? "not judged" : "MISSED",
                              gate.expectation.measure, cases::name_of(gate.expectation.quantity),
                              cases::name_of(gate.expectation.reference), reason_of(gate)),
                  4);
  }
}

Json expectations_to_json(const std::vector<Gate>& gates) {
  return json_list(gates, gate_to_json);
}

void write_gates_text(std::ostream& out, const std::vector<Comparison>& cases) {
  for (const Comparison& judged : cases) {
    for (const std::string& failure : judged.failures())
      write_line(out, false, "case", judged.scene.definition.name, failure);
    for (const Gate& gate : judged.gates) {
      write_line(out, gate.met(), cases::name_of(gate.expectation.reference), judged.scene.definition.name,
                 describe(gate) + describe_uncertainty(gate));
      if (!gate.warning.empty()) print(out, "       warning: {}\n", gate.warning);
    }
  }
  std::vector<std::string> counts;
  for (const auto& [kind, met, all] : count_by_kind(cases))
    counts.push_back(fmt::format("{} {} of {}", cases::name_of(kind), met, all));
  if (counts.empty()) counts = {"there are none"};
  print(out, "{}: {}\n", all_met(cases) ? "all gates met" : "GATES FAILED", fmt::join(counts, ", "));
}

void write_gates_junit(std::ostream& out, const std::vector<Comparison>& cases) {
  const std::vector<TestSuite> suites = make_suites(cases);
  TestSuite all;
  for (const TestSuite& suite : suites) {
    all.n += suite.n;
    all.n_failures += suite.n_failures;
    all.n_errors += suite.n_errors;
    all.tests += fmt::format("  <testsuite name=\"{}\" {}>\n{}  </testsuite>\n", in_xml(suite.name),
                             suite.counts(), suite.tests);
  }
  fmt::print(out,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"springproof\" {}>\n{}"
             "</testsuites>\n",
             all.counts(), all.tests);
}

Json gates_to_json(const std::vector<Comparison>& cases) {
  Json document = provenance();
  document["gates"] = Json::array();
  document["failures"] = Json::array();
  document["kinds"] = Json::object();
  for (const Comparison& judged : cases) {
    for (const Gate& gate : judged.gates) document["gates"].push_back(gate_of_case_to_json(judged, gate));
    for (const std::string& failure : judged.failures())
      document["failures"].push_back({{"case", judged.scene.definition.name},
                                      {"file", judged.scene.definition.file},
                                      {"reason", failure}});
  }
  for (const auto& [kind, met, all] : count_by_kind(cases))
    document["kinds"][cases::name_of(kind)] = {{"met", met}, {"all", all}};
  document["met"] = all_met(cases);
  return document;
}

void write_gates_annotations(std::ostream& out, const std::vector<Comparison>& cases) {
  for (const Comparison& judged : cases) {
    for (const std::string& failure : judged.failures())
      annotate(out, "error", judged.scene.definition.file, 1, judged.scene.definition.name, failure);
    for (const Gate& gate : judged.gates) {
      const cases::Expectation& expected = gate.expectation;
      // An expectation of the command line stands nowhere; the case's first line is as near as can be.
      const int line = std::max(1, expected.where.line);
      const std::string title =
          fmt::format("{} ({})", judged.scene.definition.name, cases::name_of(expected.reference));
      if (!gate.met()) annotate(out, "error", judged.scene.definition.file, line, title, describe(gate));
      if (!gate.warning.empty())
        annotate(out, "warning", judged.scene.definition.file, line, title,
                 expected.measure + ": " + gate.warning);
    }
  }
}

} // namespace springproof::compare
