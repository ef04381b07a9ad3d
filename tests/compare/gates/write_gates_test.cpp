#include "compare/write/write.hpp"

#include "tests/compare/gates/judged.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

using namespace springproof;

using cases::Quantity;
using cases::ReferenceKind;
using compare::Comparison;
using judged::expectation;

namespace {

/// One gate met, one outside, one without a value; a case without gates whose solve failed in strange words.
std::vector<Comparison> mixed() {
  auto missing = expectation(Quantity::fem, {0, 1}, ReferenceKind::exact);
  missing.measure = "M";
  auto first = judged::with_limit(
      judged::comparison({expectation(Quantity::error_percent, {-11, -9}),
                          expectation(Quantity::msm, {9.5, 10}, ReferenceKind::regression), missing}),
      2);
  auto second = judged::comparison({});
  second.scene.definition.name = "second";
  second.answers.msm.solution.status = cases::Status::failed;
  second.answers.msm.solution.message = "a < b & \"c\"\x01\n50 %";
  return {judged::judge(first), judged::judge(second)};
}

template<class Write>
std::string written(const Write& write, const std::vector<Comparison>& cases) {
  std::ostringstream out;
  write(out, cases);
  return out.str();
}

} // namespace

TEST_CASE("gates as text: a line each with its kind, warnings beneath, and counts per kind at the end") {
  const std::string text = written(compare::write_gates_text, mixed());
  CHECK_THAT(text,
             Catch::Contains(
                 "met    published   cube: L error_percent = -10 %, in [-11, -9] (reference +- 1.8 %)\n"
                 "       warning: the interval is narrower than the reference's own error bar, +- 1.8 %\n"
                 "FAILED regression  cube: L msm = 9 mm, not in [9.5, 10]\n"
                 "FAILED exact       cube: M fem: there is no such measure\n"));
  CHECK_THAT(text, Catch::Contains("FAILED case        second: it expects nothing"));
  CHECK_THAT(text, Catch::EndsWith("GATES FAILED: exact 0 of 1, published 1 of 1, regression 0 of 1\n"));
}

TEST_CASE("run tells how many expectations are met, and of each other one why it is missed or not judged") {
  auto explored = judged::comparison({expectation(Quantity::msm, {8, 10}), expectation(Quantity::msm, {1, 2}),
                                      expectation(Quantity::error_percent, {-11, -9})});
  explored.answers.fem.solution.status = cases::Status::skipped;
  explored.measures[0] = {"L", "mm", {}, 9.0, {}};
  const auto gates = judged::judge(explored).gates;
  std::ostringstream text;
  compare::write_expectations_text(text, gates);
  CHECK(text.str() == "  met    1 of 3 expectations\n"
                      "  MISSED L msm (published): 9 is outside [1, 2]\n"
                      "  not judged L error_percent (published): fem was not asked for\n");
  const auto document = nlohmann::json::parse(compare::expectations_to_json(gates).dump());
  REQUIRE(document.size() == 3);
  CHECK(document[0]["met"] == true);
  CHECK(document[1]["judged"] == true);
  CHECK(document[1]["met"] == false);
  CHECK(document[2]["judged"] == false);
  CHECK(document[2]["met"] == false);
  CHECK(document[2]["value"].is_null());
  CHECK(document[2]["reason"] == "fem was not asked for");
}

TEST_CASE("gates as JSON: values, error bars and verdicts, null where there is no value") {
  const auto document = nlohmann::json::parse(compare::gates_to_json(mixed()).dump());
  CHECK(document["schema"] == 1);
  CHECK(document["met"] == false);
  REQUIRE(document["gates"].size() == 3);
  const auto& first = document["gates"][0];
  CHECK(first["reference"] == "published");
  CHECK(first["value"] == -10.0);
  CHECK(first["reference_uncertainty"].get<double>() == Approx(1.8).epsilon(1e-12)); // rounding
  CHECK(first["line"] == 12);
  CHECK(document["gates"][2]["value"].is_null());
  CHECK(document["gates"][2]["reason"] == "there is no such measure");
  CHECK(document["kinds"]["regression"]["met"] == 0);
  CHECK(document["failures"].size() == 2);
}

TEST_CASE("gates as JUnit: a suite per kind, failures and errors apart, valid whatever a message holds") {
  const std::string xml = written(compare::write_gates_junit, mixed());
  CHECK_THAT(xml,
             Catch::Contains("<testsuites name=\"springproof\" tests=\"5\" failures=\"1\" errors=\"3\">"));
  CHECK_THAT(xml, Catch::Contains(
                      "<testsuite name=\"springproof.published\" tests=\"1\" failures=\"0\" errors=\"0\">"));
  CHECK_THAT(
      xml, Catch::Contains("<testsuite name=\"springproof.cases\" tests=\"2\" failures=\"0\" errors=\"2\">"));
  CHECK_THAT(xml, Catch::Contains("<failure message=\"L msm = 9 mm, not in [9.5, 10]\""));
  CHECK_THAT(xml, Catch::Contains("a &lt; b &amp; &quot;c&quot;\\x01\\n50 %"));
  const TemporaryFolder folder;
  const std::string schema = SPRINGPROOF_SOURCE_DIR "/tests/compare/gates/junit.xsd";
  auto strange = mixed();
  strange[0].gates[0].expectation.measure = "\uffff\ufffe\x1b[0m\xff";
  strange[0].gates[0].expectation.reason = "]]>\x0c";
  const auto is_valid = [&](const std::string& text) {
    const std::string path = (folder.path / "gates.xml").string();
    std::ofstream(path) << text;
    return std::system(("xmllint --noout --schema " + schema + " " + path + " 2>/dev/null").c_str()) == 0;
  };
  CHECK(is_valid(xml));
  CHECK(is_valid(written(compare::write_gates_junit, strange)));
  CHECK(is_valid(written(compare::write_gates_junit, {})));
  std::string broken = xml; // the schema does say no
  CHECK_FALSE(is_valid(broken.replace(broken.find("<failure"), 8, "<failing")));
  broken = xml;
  CHECK_FALSE(is_valid(broken.replace(broken.find("tests=\"5\""), 9, "tests=\"a\"")));
}

TEST_CASE("gates as annotations: file and line of the expectation, line breaks and percent signs escaped") {
  const std::string text = written(compare::write_gates_annotations, mixed());
  CHECK_THAT(text,
             Catch::Contains("::error file=cube.toml,line=12,title=cube (regression)::L msm = 9 mm, not in"));
  CHECK_THAT(text,
             Catch::Contains("::warning file=cube.toml,line=12,title=cube (published)::L: the interval"));
  CHECK_THAT(text, Catch::Contains("\\x01%0A50 %25\n"));
  auto odd = mixed();
  odd[0].scene.definition.file = "a,b:c.toml";
  CHECK_THAT(written(compare::write_gates_annotations, odd), Catch::Contains("file=a%2Cb%3Ac.toml,"));
}

TEST_CASE("names and reasons are data in every format: none begins a line, a command or an escape") {
  auto cases = mixed();
  const std::string strange = "L\n::add-mask::0\r##[add-mask]1\x1b[2J";
  cases[0].scene.definition.name = cases[0].gates[0].expectation.measure = strange;
  cases[0].gates[0].expectation.reason = cases[1].answers.msm.solution.message = strange;
  cases[0].gates[0].warning = strange;
  for (const auto write :
       {compare::write_gates_text, compare::write_gates_junit, compare::write_gates_annotations}) {
    const std::string text = written(write, cases);
    CHECK(text.find("\n::add-mask") == std::string::npos);
    CHECK(text.find_first_of("\r\x1b") == std::string::npos);
    CHECK(text.find("##[") == std::string::npos);
    CHECK(text.find("add-mask") != std::string::npos);
  }
}
