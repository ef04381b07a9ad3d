#include "cases/case/read_case.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("a mistake in [[measure]] is refused where it is made") {
  const std::string measure = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'\n";
  check_mistakes({
      {"name = 'alpha_1'\n", "", 26, "measure[0].name", {"is missing"}},
      {"kind = 'tilt'", "kind = 'tild'", 28, "measure[0].kind", {"coordinate", "did you mean \"tilt\"?"}},
      {"top = 'z+ x- y-'", "top = 'z+ z- y-'", 29, "measure[0].top", {"z+ and z- do not"}},
      {"toward = 'x'", "toward = 'x+'", 31, "measure[0].toward", {"is \"x+\"", "\"x\" | \"y\" | \"z\""}},
      {"toward = 'x'", "toward = 'z'", 31, "measure[0].toward", {"another axis than up"}},
      {"toward = 'x'", "toward = 'x'\nup = 'up'", 32, "measure[0].up", {"is \"up\""}},
      {"bottom = 'z- x- y-'", "bottom = 'z+ x- y-'", 29, "measure[0].top", {"another node than bottom"}},
      {"toward = 'x'", "toward = 'x'\nnode = 'z+'", 32, "measure[0].node", {"is not a key here", "toward"}},
      {"toward = 'x'\n",
       "toward = 'x'\n[[measure]]\nname = 'alpha_1'\nkind = 'volume'\n",
       33,
       "measure[1].name",
       {"is \"alpha_1\"", "measure[0]"}},
      {measure, "kind = 'coordinate'\nnode = 'z+'\n", 26, "measure[0].axis", {"is missing"}},
      {measure,
       "kind = 'displacement'\nnode = 'z+'\ncomponent = 'w'\n",
       30,
       "measure[0].component",
       {"\"norm\""}},
      {measure,
       "kind = 'twist'\nnode = 'near 5 5 10'\ncentre = 'near 5 5 10'\n",
       29,
       "measure[0].node",
       {"another node than centre"}},
  });
}

TEST_CASE("a mistake in [[expect]] is refused where it is made") {
  check_mistakes({
      {"measure = 'alpha_1'",
       "measure = 'alpha_2'",
       33,
       "expect[0].measure",
       {"is \"alpha_2\"", "did you mean \"alpha_1\"?"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [0.0, -8.0]",
       34,
       "expect[0].error_percent",
       {"lower <= upper"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [0.0]",
       34,
       "expect[0].error_percent",
       {"two finite numbers"}},
      {"error_percent = [-8.0, 0.0]\n", "", 32, "expect[0].error_percent", {"is missing", "msm", "fem"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [-8.0, 0.0]\nfem = [1, 2]",
       35,
       "expect[0].fem",
       {"left out"}},
      {"reference = 'published'",
       "reference = 'printed'",
       35,
       "expect[0].reference",
       {"exact", "regression"}},
      {"reason = 'Table 4.5'", "reason = ''", 36, "expect[0].reason", {"not empty"}},
      {"reason = 'Table 4.5'\n", "", 32, "expect[0].reason", {"is missing"}},
  });
}
