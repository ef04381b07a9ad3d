#include "compare/report/sections.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using Catch::Contains;
namespace html = compare::html;

TEST_CASE(
    "for E = 50 kPa and nu = 0.45 the report names a design, its stiffnesses and the errors to expect") {
  compare::ThesisResults results;
  compare::Advice advice;
  advice.poissons_ratio = 0.45;
  advice.design = "hybrid";
  advice.stiffness = msm::CellStiffness{0.2, 0.04, 0.25, 2};
  advice.small = {4.0, 1.5, 0.5, true};
  advice.large = {13.1, 5.0, 1.16, true};
  advice.is_recommended = true;
  advice.trace.command = "build/springproof design --young 1";
  results.advice = {advice};
  const std::string page = html::advice_section(results);
  // E L0 = 0.05 N/mm = 50 N/m
  CHECK_THAT(page, Contains("ν = 0.45: <b>hybrid</b>; for E = 50 kPa"));
  for (const char* stiffness :
       {"<sub>e</sub> = 10.00", "<sub>f</sub> = 2.00", "<sub>d</sub> = 12.50", "<sub>v</sub> = 0.10000"})
    CHECK_THAT(page, Contains(stiffness));
  for (const char* error : {"4.0 %", "13.1 %", "1.16 %", "build/springproof design --young 1"})
    CHECK_THAT(page, Contains(error));
}

TEST_CASE("a design that was refused is in the report with its reason and without figures") {
  compare::ThesisResults results;
  compare::Advice advice;
  advice.poissons_ratio = 0.2;
  advice.design = "hybrid";
  advice.refusal = "needs nu >= 0.25";
  results.advice = {advice};
  const std::string page = html::advice_section(results);
  CHECK_THAT(page, Contains("needs nu &gt;= 0.25"));
  CHECK_THAT(page, Contains("refused"));
  CHECK_THAT(page, !Contains("<li"));
}

TEST_CASE("a figure without a value is shown as such, with the reason beside its command") {
  compare::ThesisResults results;
  compare::ComputedFigure computed;
  computed.reference = "hyperelastic q1_p0";
  computed.reason = "springs: no equilibrium <at> this load";
  computed.trace = {"thesis/ogden/bar.toml", {"msm.split=0.5"}, "build/springproof run bar.toml"};
  results.entries = {
      {{"5.12", "ogden", 0.5, "nonlinear_method", 0.5, "", "bar", "deflection", "%", -8}, {computed}, ""}};
  const std::string page = html::tables_section(results);
  CHECK_THAT(page, Contains("no value: springs: no equilibrium &lt;at&gt; this load"));
  CHECK_THAT(page, Contains("<code>build/springproof run bar.toml</code>"));
  CHECK_THAT(page, Contains("setting: msm.split=0.5"));
  CHECK_THAT(page, Contains("class='beyond'>no value"));
}

TEST_CASE("what the results have nothing for has no section") {
  const compare::ThesisResults none;
  CHECK(html::advice_section(none).empty());
  CHECK(html::designs_section(none).empty());
  CHECK(html::volumes_section(none).empty());
  CHECK(html::views_section(none, {}, "").empty());
}
