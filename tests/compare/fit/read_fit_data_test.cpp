#include "cases/case/error.hpp"
#include "compare/fit/fit.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>

using namespace springproof;
using namespace compare;

namespace {

const std::string body = R"(schema = 1
name = "bar"
body = { shape = "box", size = [10, 10, 10], cells = [2, 2, 2] }
material = { model = "linear_elastic", youngs_modulus = 1, poissons_ratio = 0.3 }
fixed = [{ region = "z-" }]
load = [{ region = "z+", kind = "traction", value = [0, 0, 0.01] }]
measure = [{ name = "end", kind = "displacement", node = "near 0 0 10", component = "z" },
           { name = "all", kind = "displacement_field_l2" }]
)";

} // namespace

TEST_CASE("rows of data are read into the states that are solved for them") {
  const TemporaryFolder folder;
  const FitCases cases{{folder.write("bar.toml", body)}, {}, {}};
  const FitData data = read_fit_data("# pulled twice\nload[0].value[2],end,sigma,x,y,z,ux\n"
                                     "0.01,1.5,0.1,0,0,10,\n0.01,,0.1,5,5,10,2\n0.02,3,0.2,0,0,10,\n",
                                     "data.csv", {cases.files, {}, {}});
  REQUIRE(data.states.size() == 2);
  CHECK(data.states[0].settings == std::vector<std::string>{"load[0].value[2]=0.01"});
  CHECK(data.states[0].markers.size() == 1);
  REQUIRE(data.data.size() == 3);
  CHECK(data.data[0].value == 1.5);
  CHECK(data.data[0].line == 3);
  CHECK(data.data[1].measure.name == "ux at (5, 5, 10)");
  CHECK(data.data[2].state == 1);
  CHECK(data.data[2].deviation == 0.2);
}

TEST_CASE("a row without a marker's place or a key's value is of measures, under the case's own value") {
  const TemporaryFolder folder;
  const FitCases one{{folder.write("bar.toml", body)}, {}, {}};
  const FitData data =
      read_fit_data("x,y,z,uz,end,load[0].value[2]\n5,5,5,0.1,,0.02\n,,,,0.2,\n", "data.csv", one);
  REQUIRE(data.data.size() == 2);
  REQUIRE(data.states.size() == 2);
  CHECK(data.states[0].settings == std::vector<std::string>{"load[0].value[2]=0.02"});
  CHECK(data.states[0].markers.size() == 1);
  CHECK(data.states[1].settings.empty());
  CHECK(data.states[1].markers.empty());
  CHECK(data.data[1].measure.name == "end");
}

TEST_CASE("a mistake in data is refused with its line") {
  const TemporaryFolder folder;
  const FitCases one{{folder.write("bar.toml", body)}, {}, {}};
  const std::string second = folder.write("second.toml", case_text::replaced(body, "\"bar\"", "\"second\""));
  const FitCases two{one.files, {second}, {}};
  const auto refused = [](const FitCases& cases, const std::string& text, const std::string& says) {
    CHECK_THROWS_WITH(read_fit_data(text, "data.csv", cases), Catch::Contains(says));
  };
  refused(one, "1,2\n", "data.csv:1: is no heading");
  refused(one, "end\n", "data.csv: has no rows");
  refused(one, "", "data.csv: has no rows");
  refused(one, "ende\n1\n",
          "data.csv:1: \"ende\" is no column, must be a measure of the cases (\"end\" | \"all\")");
  refused(one, "end\none\n", "data.csv:2: \"one\" is no finite number");
  refused(one, "end\nnan\n", "data.csv:2: \"nan\" is no finite number");
  refused(one, "end,sigma\n1\n", "data.csv:2: has 1 fields, must have 2");
  refused(one, "end,sigma\n1,0\n", "data.csv:2: 0 is no standard deviation");
  refused(one, "end,sigma\n,1\n", "data.csv:2: has no datum");
  refused(one, "all\n1\n", "data.csv:2: all: is the norm of a field, which --to limit fits");
  refused(one, "x,y,ux\n1,2,3\n", "data.csv:2: ux: markers need the columns x, y and z");
  refused(one, "x,y,z,ux\n1,,2,3\n", "data.csv:2: ux: markers need the columns x, y and z");
  refused(two, "end\n1\n", "no column \"case\"");
  refused(two, "case,end\nthird,1\n", "data.csv:2: case is \"third\", must be \"bar\" | \"second\"");
  refused({{one.files[0], one.files[0]}, {}, {}}, "case,end\nbar,1\n", "is named \"bar\" as");
}
