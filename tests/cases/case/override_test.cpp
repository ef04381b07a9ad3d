#include "cases/case/read_case.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("settings of the command line replace and add values") {
  const Case c =
      read_text(good_case, {"load[0].value=[0, 0, 0.01]", "fem.element=q1", "fem.refine = 0",
                            "measure[0].top=z+ x+ y-", "measure[0].bottom = \"z- x+ y-\"", "name=a b",
                            "msm={design=\"given\", stiffness=[1,2,3]}", "expect[0].error_percent=[-1,1]"});
  const auto force_of = [](const Case& read) {
    return std::get<loads::NodalForce>(read.loads[0].kind).value;
  };
  CHECK(force_of(c) == Eigen::Vector3d(0, 0, 0.01));
  CHECK(c.fem.element == Element::q1);
  CHECK(c.fem.refine == 0);
  const auto& tilt = std::get<measures::Tilt>(c.measures[0].kind);
  CHECK(tilt.top.name == "z+ x+ y-");
  CHECK(tilt.bottom.name == "z- x+ y-");
  CHECK(c.name == "a b");
  CHECK(c.msm.design == Design::given);
  CHECK(c.expectations[0].interval == std::array<double, 2>{-1, 1});
  const Case single = read_text(good_case, {"load[0].value[2]=0.5"});
  CHECK(force_of(single) == Eigen::Vector3d(0.002, 0, 0.5));
}

// A design on the command line left keys of the file's own design to be refused, and the way out was not
// told. Looked for the same kind: every table whose keys depend on each other (material.model,
// fem.formulation, dynamics.scheme, msm.law); all are refused by one function.
TEST_CASE("a key of the file that a setting leaves without a meaning is refused with the way out") {
  const auto refusal = [](const std::string& text, const std::string& setting) {
    try {
      read_text(text, {setting});
    } catch (const InputError& error) {
      CHECK(error.where().line > 0);
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string given = replaced(good_case, "design = 'moduli'\npoissons_ratio = 0.3\nsplit = 0.8",
                                     "design = 'given'\nstiffness = [1, 2, 3]");
  const std::string said = refusal(given, "msm.design=matched");
  CHECK_THAT(said,
             Catch::Contains("msm.stiffness: is [1, 2, 3], must be left out: it belongs to design") &&
                 Catch::EndsWith("without what the file has there: --set 'msm={design = \"matched\"}'"));
  CHECK(read_text(given, {"msm={design = \"matched\"}"}).msm.design == Design::matched);
  CHECK(read_text(given, {"msm.design=given"}).msm.stiffness == std::array<double, 3>{1, 2, 3});
  // There is nothing to replace without a setting, or with the refused key as one.
  CHECK(refusal(given, "fem.refine=0").find("--set") == std::string::npos);
  CHECK_THROWS_WITH(read_text(good_case, {"msm.design=matched", "msm.stiffness=[1, 2, 3]"}),
                    !Catch::Contains("--set"));
}

TEST_CASE("a mistake in a setting of the command line is told as such") {
  const std::vector<std::pair<std::string, std::string>> settings{
      {"fem.element=q9", "command line: fem.element: is \"q9\", must be \"q1\""},
      {"fem.elment=q1", "command line: fem.elment: is not a key here"},
      {"fem.refine=1e", "command line: fem.refine: is \"1e\", must be a whole number"},
      {"fem.refine=2\nname='x'", "command line: fem.refine: is"},
      {"load[1].value=[0,0,1]", "command line: load[1].value: there is no load[1], load has 1 elements"},
      {"load[0].value=[0,0", "command line: load[0].value: is \"[0,0\", must be"},
      {"load[x].value=1", "command line: load[x].value: is not a key"},
      {"name.first=1", "command line: name.first: name is not a table"},
      {"fem..refine=1", "command line: fem..refine: is not a key"},
      {"fem.refine", "command line: fem.refine: is not KEY=VALUE"},
      {"fem.refine=", "command line: fem.refine: has no value"},
      {"=1", "command line: is not a key"},
      {"material.poissons_ratio=0.5", "command line: material.poissons_ratio: is 0.5, must be"},
      {"schema=nan", "command line: schema: is nan, must be 1"},
  };
  for (const auto& [setting, message] : settings) {
    INFO(setting);
    CHECK_THROWS_WITH(read_text(good_case, {setting}), Catch::StartsWith(message));
  }
}
