#include "compare/report/pages.hpp"

#include "compare/provenance/whole_file.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace springproof;

using Catch::Contains;

TEST_CASE("no text of the embedded data ends its script or begins a comment") {
  const std::string name = "x</script><!--<script>\xe2\x80\xa8\"'\xff";
  const std::string text = compare::embedded({{"name", name}});
  CHECK_THAT(text, !Contains("<") && !Contains("\xe2\x80\xa8"));
  CHECK(nlohmann::json::parse(text)["name"] == "x</script><!--<script>\xe2\x80\xa8\"'\xef\xbf\xbd");
}

TEST_CASE(
    "a page is one file: nothing is left to be filled in, and every library is in it with its licence") {
  const TemporaryFolder folder;
  const std::string file = folder.path.string() + "/page.html";
  compare::write_page(
      file, "a <title>",
      {{"heading", "</script><script>alert(1)</script>"}, {"times", nlohmann::ordered_json::array()}});
  const std::string page = compare::read_file(file);
  CHECK_THAT(page,
             Contains("<title>a &lt;title&gt;</title>") && Contains("Chart.js v3") && Contains("THREE"));
  CHECK_THAT(page, !Contains("{{") && !Contains("alert(1)</script>"));
  CHECK_THAT(page, Contains("three.js authors") && Contains("Chart.js Contributors"));
}
