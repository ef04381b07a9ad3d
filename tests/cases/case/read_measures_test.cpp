#include "cases/case/read_case.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("a mistake in [[measure]] is refused where it is made") {
  const std::string measure = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'\n";
  const auto refused = mistakes_in(good_case);
  refused("name = 'alpha_1'\n", "", 26, "measure[0].name", {"is missing"});
  refused("kind = 'tilt'", "kind = 'tild'", 28, "measure[0].kind", {"coordinate", "did you mean \"tilt\"?"});
  refused("top = 'z+ x- y-'", "top = 'z+ z- y-'", 29, "measure[0].top", {"z+ and z- do not"});
  refused("toward = 'x'", "toward = 'x+'", 31, "measure[0].toward", {"is \"x+\"", "\"x\" | \"y\" | \"z\""});
  refused("toward = 'x'", "toward = 'z'", 31, "measure[0].toward", {"another axis than up"});
  refused("toward = 'x'", "toward = 'x'\nup = 'up'", 32, "measure[0].up", {"is \"up\""});
  refused("bottom = 'z- x- y-'", "bottom = 'z+ x- y-'", 29, "measure[0].top", {"another node than bottom"});
  refused("toward = 'x'", "toward = 'x'\nnode = 'z+'", 32, "measure[0].node",
          {"is not a key here", "toward"});
  refused("toward = 'x'\n", "toward = 'x'\n[[measure]]\nname = 'alpha_1'\nkind = 'volume'\n", 33,
          "measure[1].name", {"is \"alpha_1\"", "measure[0]"});
  refused(measure, "kind = 'coordinate'\nnode = 'z+'\n", 26, "measure[0].axis", {"is missing"});
  refused(measure, "kind = 'displacement'\nnode = 'z+'\ncomponent = 'w'\n", 30, "measure[0].component",
          {"\"norm\""});
  refused(measure, "kind = 'twist'\nnode = 'near 5 5 10'\ncentre = 'near 5 5 10'\n", 29, "measure[0].node",
          {"another node than centre"});
}

TEST_CASE("a displacement is measured at a node, at the node nearest to a point, or at a point of a cell") {
  const std::string tilt = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'\n";
  const auto node_of = [&](const std::string& keys) {
    const Case c = read_text(replaced(good_case, tilt, "kind = 'displacement'\ncomponent = 'x'\n" + keys));
    return std::get<measures::Displacement>(c.measures[0].kind).node;
  };
  CHECK(node_of("at = [1, 2, 3]\n").is_in_cell);
  CHECK(node_of("at = [1, 2, 3]\n").near == Eigen::Vector3d(1, 2, 3));
  CHECK(node_of("nearest = [1, 2, 3]\ntolerance = 0.5\n").tolerance == 0.5);
  CHECK(node_of("node = { nearest = [1, 2, 3], tolerance = 0.5 }\n").tolerance == 0.5);
  const auto refused = mistakes_in(good_case);
  refused(tilt, "kind = 'displacement'\ncomponent = 'x'\nat = [1, 2, 3]\nnode = 'z+'\n", 31,
          "measure[0].node", {"left out beside at"});
  refused(tilt, "kind = 'displacement'\ncomponent = 'x'\nnode = { at = [1, 2, 3] }\n", 30,
          "measure[0].node.nearest", {"is missing"});
  refused(tilt, replaced(tilt, "top = 'z+ x- y-'", "at = [1, 2, 3]\ntop = 'z+ x- y-'"), 29, "measure[0].at",
          {"is not a key here"});
}

TEST_CASE("a mistake in a measure of forces, stress or strain is refused where it is made") {
  const std::string measure = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'\n";
  const auto refused = mistakes_in(good_case);
  refused(measure, "kind = 'reaction'\ncomponent = 'x'\n", 26, "measure[0].region", {"is missing"});
  refused(measure, "kind = 'reaction'\nregion = 'z-'\n", 26, "measure[0].component", {"is missing"});
  refused(measure, "kind = 'reaction'\nregion = 'z-'\ncomponent = 'xx'\n", 30, "measure[0].component",
          {"\"norm\""});
  refused(measure, "kind = 'stress'\ncomponent = 'xx'\n", 26, "measure[0].point", {"is missing"});
  refused(measure, "kind = 'stress'\npoint = [5, 5]\ncomponent = 'xx'\n", 29, "measure[0].point",
          {"three finite numbers"});
  refused(measure, "kind = 'stress'\npoint = [5, 5, 5]\ncomponent = 'mises'\n", 30, "measure[0].component",
          {"von_mises", "principal_1"});
  refused(measure, "kind = 'strain'\npoint = [5, 5, 5]\ncomponent = 'von_mises'\n", 30,
          "measure[0].component", {"\"principal_3\""});
  refused(measure, "kind = 'strain_energy'\nregion = 'z-'\n", 29, "measure[0].region", {"is not a key here"});
}

TEST_CASE("a case asks for fields when a measure is of them") {
  const std::string measure = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'\n";
  CHECK_FALSE(read_text(good_case).has_fields);
  CHECK_FALSE(read_text(replaced(good_case, measure, "kind = 'volume'\n")).has_fields);
  for (const char* of_fields :
       {"kind = 'strain_energy'\n", "kind = 'reaction'\nregion = 'z-'\ncomponent = 'norm'\n",
        "kind = 'stress'\npoint = [5, 5, 5]\ncomponent = 'von_mises'\n",
        "kind = 'strain'\npoint = [5, 5, 5]\ncomponent = 'principal_2'\n"})
    CHECK(read_text(replaced(good_case, measure, of_fields)).has_fields);
}

TEST_CASE("a mistake in [[expect]] is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  refused("measure = 'alpha_1'", "measure = 'alpha_2'", 33, "expect[0].measure",
          {"is \"alpha_2\"", "did you mean \"alpha_1\"?"});
  refused("error_percent = [-8.0, 0.0]", "error_percent = [0.0, -8.0]", 34, "expect[0].error_percent",
          {"lower <= upper"});
  refused("error_percent = [-8.0, 0.0]", "error_percent = [0.0]", 34, "expect[0].error_percent",
          {"two finite numbers"});
  refused("error_percent = [-8.0, 0.0]\n", "", 32, "expect[0].error_percent", {"is missing", "msm", "fem"});
  refused("error_percent = [-8.0, 0.0]", "error_percent = [-8.0, 0.0]\nfem = [1, 2]", 35, "expect[0].fem",
          {"left out"});
  refused("reference = 'published'", "reference = 'printed'", 35, "expect[0].reference",
          {"exact", "regression"});
  refused("reason = 'Table 4.5'", "reason = ''", 36, "expect[0].reason", {"not empty"});
  refused("reason = 'Table 4.5'\n", "", 32, "expect[0].reason", {"is missing"});
}

TEST_CASE("a statistic of a strain is of a region or of all cells, and has no point") {
  const std::string from = "kind = 'tilt'\ntop = 'z+ x- y-'\nbottom = 'z- x- y-'\ntoward = 'x'";
  const auto with = [&](const std::string& keys) {
    return replaced(good_case, from, "kind = 'strain'\ncomponent = 'principal_1'\n" + keys);
  };
  const auto read = [&](const std::string& keys) {
    return std::get<measures::Strain>(read_text(with(keys)).measures[0].kind);
  };
  CHECK(read("statistic = 'deviation'\nregion = 'z-'").statistic == Statistic::deviation);
  CHECK(read("statistic = 'deviation'\nregion = 'z-'").region.name == "z-");
  CHECK_FALSE(read("statistic = 'largest'").has_region());
  CHECK_THROWS_WITH(read_text(with("statistic = 'mean'\npoint = [1, 1, 1]")),
                    Catch::Contains("left out beside statistic"));
  CHECK_THROWS_WITH(read_text(with("region = 'z-'\npoint = [1, 1, 1]")),
                    Catch::Contains("left out without statistic"));
  const Case c = read_text(replaced(good_case, from, "kind = 'curvature'\nregion = 'z+ x-'\naxis = 'y'"));
  CHECK(std::get<measures::Curvature>(c.measures[0].kind).axis == Axis::y);
}
