#include "compare/write/write_gates.hpp"

#include "cases/case/names.hpp"
#include "compare/write/escape.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

namespace springproof::compare {

namespace {

/// XML 1.0 has no place for control characters, however they are written.
std::string escaped(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' && c != '\n' && c != '\t') c = '?';
  return escape(text);
}

struct TestCase {
  std::string name, class_name;
  std::string element; ///< "failure" or "error"; empty: passed
  std::string message;
  std::string output; ///< what a server shows besides
};

struct TestSuite {
  std::string name;
  std::vector<TestCase> tests;
  std::size_t count(const std::string& element) const {
    std::size_t n = 0;
    for (const TestCase& test : tests)
      if (test.element == element) ++n;
    return n;
  }
};

TestCase test_of(const GatedCase& judged, const Gate& gate) {
  const cases::Expectation& expected = gate.judgement.expectation;
  TestCase test;
  test.name = fmt::format("{} {} in [{}, {}]", expected.measure, cases::name_of(expected.quantity),
                          expected.interval[0], expected.interval[1]);
  test.class_name = judged.name;
  if (!gate.met()) test.element = gate.judgement.value ? "failure" : "error";
  test.message = describe(gate);
  test.output =
      fmt::format("{}{}\ninterval: {}\n", describe(gate), describe_uncertainty(gate), expected.reason);
  if (!gate.warning.empty()) test.output += "warning: " + gate.warning + "\n";
  return test;
}

/// Suites are named after kinds, a suite for what failed as a whole first; empty ones are left out.
std::vector<TestSuite> make_suites(const std::vector<GatedCase>& cases) {
  std::vector<TestSuite> suites{{"springproof.cases", {}}};
  for (const GatedCase& judged : cases)
    for (std::size_t f = 0; f < judged.failures.size(); ++f) {
      const std::string number = f == 0 ? "" : fmt::format(" ({})", f + 1);
      suites.front().tests.push_back(
          {"solved and judged" + number, judged.name, "error", judged.failures[f], ""});
    }
  if (suites.front().tests.empty()) suites.clear();
  for (const GateCount& count : count_by_kind(cases)) {
    suites.push_back({"springproof." + cases::name_of(count.kind), {}});
    for (const GatedCase& judged : cases)
      for (const Gate& gate : judged.gates)
        if (gate.judgement.expectation.reference == count.kind)
          suites.back().tests.push_back(test_of(judged, gate));
  }
  return suites;
}

void write_test(std::ostream& out, const TestCase& test) {
  fmt::print(out, "    <testcase name=\"{}\" classname=\"{}\">\n", escaped(test.name),
             escaped(test.class_name));
  if (!test.element.empty())
    fmt::print(out, "      <{0} message=\"{1}\" type=\"{0}\">{1}</{0}>\n", test.element,
               escaped(test.message));
  if (!test.output.empty()) fmt::print(out, "      <system-out>{}</system-out>\n", escaped(test.output));
  fmt::print(out, "    </testcase>\n");
}

} // namespace

void write_gates_junit(std::ostream& out, const std::vector<GatedCase>& cases) {
  const std::vector<TestSuite> suites = make_suites(cases);
  std::size_t tests = 0, failures = 0, errors = 0;
  for (const TestSuite& suite : suites) {
    tests += suite.tests.size();
    failures += suite.count("failure");
    errors += suite.count("error");
  }
  const auto counts = [](std::size_t all, std::size_t failed, std::size_t broken) {
    return fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\"", all, failed, broken);
  };
  fmt::print(out, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"springproof\" {}>\n",
             counts(tests, failures, errors));
  for (const TestSuite& suite : suites) {
    fmt::print(out, "  <testsuite name=\"{}\" {}>\n", escaped(suite.name),
               counts(suite.tests.size(), suite.count("failure"), suite.count("error")));
    for (const TestCase& test : suite.tests) write_test(out, test);
    fmt::print(out, "  </testsuite>\n");
  }
  fmt::print(out, "</testsuites>\n");
}

} // namespace springproof::compare
