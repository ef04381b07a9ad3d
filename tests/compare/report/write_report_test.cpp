#include "compare/report/pages.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace springproof;

TEST_CASE("a figure without a value is on the page with the reason and its command") {
  compare::ThesisResults results;
  compare::ComputedFigure computed;
  computed.reference = "hyperelastic q1_p0";
  computed.reason = "springs: no equilibrium <at> this load";
  computed.trace = {"thesis/ogden/bar.toml", {"msm.split=0.5"}, "build/springproof run bar.toml"};
  results.entries = {
      {{"5.12", "ogden", 0.5, "nonlinear_method", 0.5, "", "bar", "deflection", "%", -8}, {computed}, ""}};
  const auto page = compare::report_to_json(results, {});
  const auto& figure = page["entries"][0]["computed_by"][0];
  CHECK(figure["value"].is_null());
  CHECK(figure["reason"] == "springs: no equilibrium <at> this load");
  CHECK(figure["command"] == "build/springproof run bar.toml");
  CHECK(page["sheets"][0]["name"] == "Figure 5.12");
  CHECK(page["summary"]["groups"][0]["command"] == "build/springproof tables 5.12");
}
