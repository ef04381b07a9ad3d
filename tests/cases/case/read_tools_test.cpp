#include "cases/case/readers.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

namespace {

const std::string load = "[[load]]\nregion = 'z+'\nkind = 'nodal_force'\nvalue = [0.002, 0, 0.0]\n";

std::string pressed(const std::string& tools) {
  return replaced(good_case, load, tools);
}

const std::string ball = "[[tool]]\nname = 'ball'\nshape = 'sphere'\ncentre = [5, 5, 14]\nradius = 4\n"
                         "displacement = [0, 0, -1]\n";

std::string from_rest() {
  return replaced(dynamic_case, "start = 'equilibrium'", "start = 'rest'");
}

} // namespace

TEST_CASE("tools of every shape are read, and one that moves takes the place of a load") {
  const Case c = read_text(pressed(
      ball + "steps = 3\nfriction = 0.3\n[[tool]]\nname = 'bar'\nshape = 'cylinder'\ncentre = [5, 5, "
             "20]\nradius = 4\n"
             "axis = 'y'\n[[tool]]\nname = 'punch'\nshape = 'punch'\ncentre = [5, 5, 30]\nradius = 4\n"
             "axis = [0, 0, -2]\n[[tool]]\nname = 'floor'\nshape = 'plane'\npoint = [0, 0, -1]\n"
             "normal = 'z'\nregion = 'z-'\n"));
  CHECK(c.loads.empty());
  REQUIRE(c.tools.size() == 4);
  CHECK(c.tools[0].name == "ball");
  CHECK(std::get<tools::Sphere>(c.tools[0].shape).radius == 4);
  CHECK(c.tools[0].at == Eigen::Vector3d(5, 5, 14));
  CHECK(c.tools[0].displacement == Eigen::Vector3d(0, 0, -1));
  CHECK(least_load_steps(c) == 3);
  CHECK(c.tools[0].friction == 0.3);
  CHECK(c.tools[1].friction == 0);
  CHECK(std::get<tools::Cylinder>(c.tools[1].shape).axis == Eigen::Vector3d::UnitY());
  CHECK(std::get<tools::Punch>(c.tools[2].shape).axis == -Eigen::Vector3d::UnitZ());
  CHECK(std::get<tools::Plane>(c.tools[3].shape).normal == Eigen::Vector3d::UnitZ());
  CHECK(c.tools[3].region->name == "z-");
  CHECK_FALSE(c.tools[0].region);
}

TEST_CASE(
    "a tool that is a file's surface begins where its file is, or its origin at the centre or the path") {
  const TemporaryFolder folder;
  folder.write("probe.stl", "");
  const std::string probe = "[[tool]]\nname = 'probe'\nshape = 'surface'\nfile = 'probe.stl'\n";
  const auto read = [&](const std::string& text) {
    return read_case(folder.write("case.toml", text)).tools[0];
  };
  const Tool there = read(pressed(probe + "displacement = [0, 0, -1]\n")),
             moved = read(pressed(probe + "scale = 10\ncentre = [5, 5, 14]\ndisplacement = [0, 0, -1]\n")),
             led = read(replaced(from_rest(), "[[load]]", probe + "path = [[0, 5, 5, 14]]\n[[load]]"));
  CHECK(std::get<tools::Surface>(there.shape).file.path == (folder.path / "probe.stl").string());
  CHECK(std::get<tools::Surface>(moved.shape).scale == 10);
  CHECK(there.place(0) == Eigen::Vector3d::Zero());
  CHECK(moved.place(0) == Eigen::Vector3d(5, 5, 14));
  CHECK(led.place(0) == Eigen::Vector3d(5, 5, 14));
}

TEST_CASE("measures of a tool are read by its name") {
  const Case c = read_text(
      replaced(pressed(ball), "[[measure]]",
               "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'ball'\ncomponent = 'z'\n"
               "[[measure]]\nname = 'torque'\nkind = 'tool_torque'\ntool = 'ball'\ncomponent = 'norm'\n"
               "[[measure]]\nname = 'area'\nkind = 'contact_area'\ntool = 'ball'\n"
               "[[measure]]\nname = 'depth'\nkind = 'penetration'\ntool = 'ball'\n[[measure]]"));
  CHECK(std::get<measures::ToolForce>(c.measures[0].kind).component == Component::z);
  CHECK(std::get<measures::ToolTorque>(c.measures[1].kind).component == Component::norm);
  CHECK(is<measures::ContactArea>(c.measures[2]));
  CHECK(is<measures::Penetration>(c.measures[3]));
}

TEST_CASE("a mistake in a tool is refused where it stands, with what is allowed") {
  const std::string good = pressed(ball);
  const auto refused = mistakes_in(good);
  const auto line_of = [&](const std::string& text) {
    return 1 + static_cast<int>(std::count(good.begin(), good.begin() + long(good.find(text)), '\n'));
  };
  refused("'sphere'", "'cube'", line_of("shape = 'sphere'"), "tool[0].shape",
          {"\"sphere\" | \"cylinder\" | \"punch\" | \"plane\" | \"surface\""});
  for (const char* key : {"axis = 'z'", "file = 'probe.stl'", "scale = 2"})
    refused("radius = 4", std::string("radius = 4\n") + key, line_of("radius = 4") + 1,
            "tool[0]." + std::string(key).substr(0, std::string(key).find(' ')),
            {"left out: it belongs to another shape than \"sphere\""});
  const auto of_file = [](const std::string& keys) { return "'surface'\nfile = '" + keys + "'"; };
  refused("'sphere'", of_file("none.stl"), line_of("shape = 'sphere'") + 1, "tool[0].file",
          {"a file that exists: there is no "});
  refused("'sphere'", of_file("case.toml"), line_of("shape = 'sphere'") + 1, "tool[0].file",
          {"a closed surface, .stl, .obj, .ply or .vtp"});
  refused("radius = 4", "radius = 0", line_of("radius = 4"), "tool[0].radius", {"a number above 0 (mm)"});
  refused("radius = 4", "radius = 4\nregion = { box = [[0, 0, 0], [5, 5, 5]] }", line_of("radius = 4") + 1,
          "tool[0].region", {"the name of a region, or a table with plane"});
  for (const char* friction : {"-0.1", "5.1", "nan", "'rough'"})
    refused("radius = 4", std::string("radius = 4\nfriction = ") + friction, line_of("radius = 4") + 1,
            "tool[0].friction", {"a number from 0 to 5: Coulomb's coefficient"});
  refused("displacement = [0, 0, -1]", "displacement = 1", line_of("displacement"), "tool[0].displacement",
          {"three finite numbers (mm)"});
  refused("displacement = [0, 0, -1]\n", "", 1, "load", {"[[tool]] with a displacement"});
  refused(ball, ball + ball, line_of("name = 'ball'") + 6, "tool[1].name", {"a new name"});
  refused("kind = 'tilt'", "kind = 'tool_force'\ntool = 'bell'", line_of("kind = 'tilt'") + 1,
          "measure[0].tool", {"\"ball\""});
  refused("design = 'moduli'", "design = 'moduli'\nsolver = 'fire'", line_of("[[tool]]"), "tool[0]",
          {"left out beside another solver than \"newton\""});
}

TEST_CASE("a tool of a motion has a history or a path, and takes the place of a load") {
  const auto moved = [&](const std::string& tool) {
    return replaced(from_rest(), "[[load]]", tool + "[[load]]");
  };
  const Case by_history = read_text(moved(ball + "history = { ramp = [0.01, 0.03] }\n"));
  REQUIRE(by_history.tools.size() == 1);
  CHECK(by_history.tools[0].place(0) == Eigen::Vector3d(5, 5, 14));
  CHECK(by_history.tools[0].place(0.02).isApprox(Eigen::Vector3d(5, 5, 13.5)));
  CHECK(by_history.tools[0].place(1) == Eigen::Vector3d(5, 5, 13));
  const Case by_path = read_text(moved("[[tool]]\nname = 'ball'\nshape = 'sphere'\nradius = 4\n"
                                       "path = [[0.01, 5, 5, 14], [0.03, 5, 7, 13]]\n"));
  REQUIRE(by_path.tools.size() == 1);
  CHECK(by_path.tools[0].place(0) == Eigen::Vector3d(5, 5, 14));
  CHECK(by_path.tools[0].place(0.015).isApprox(Eigen::Vector3d(5, 5.5, 13.75)));
  CHECK(by_path.tools[0].place(0.03) == Eigen::Vector3d(5, 7, 13));
  CHECK(by_path.tools[0].place(2) == Eigen::Vector3d(5, 7, 13));
}

TEST_CASE("a mistake in how a tool moves is refused where it stands") {
  const std::string good =
      replaced(from_rest(), "[[load]]", ball + "history = { ramp = [0, 0.1] }\n[[load]]");
  const auto line_of = [&](const std::string& text) {
    return 1 + static_cast<int>(std::count(good.begin(), good.begin() + long(good.find(text)), '\n'));
  };
  const auto refused = mistakes_in(good);
  const int at_tool = line_of("[[tool]]"), at_history = line_of("history = { ramp = [0, 0.1] }");
  refused("history = { ramp = [0, 0.1] }\n", "", at_tool, "tool[0]", {"history is missing"});
  refused("history = { ramp = [0, 0.1] }", "history = { step = 0.1 }", at_tool, "tool[0]", {"history jumps"});
  refused("displacement = [0, 0, -1]\n", "", at_tool, "tool[0]", {"history must be left out"});
  refused("scheme = 'newmark'", "scheme = 'generalized_alpha'\nrho_infinity = 0.5", line_of("[dynamics]"),
          "dynamics", {"rho_infinity is 0.5, must be 0 beside [[tool]]"});
  refused("mass = 'uniform'", "mass = 'uniform'\niterations_per_step = 10", at_tool, "tool[0]",
          {"left out beside msm.iterations_per_step"});
  refused("start = 'rest'", "start = 'equilibrium'", at_tool, "tool[0]", {"starts at rest"});
  refused("history = { ramp = [0, 0.1] }", "steps = 2", at_history, "tool[0].steps",
          {"left out beside [dynamics]"});
  refused("history = { ramp = [0, 0.1] }", "path = [[0, 1, 1, 1]]", line_of("centre"), "tool[0].centre",
          {"left out beside path"});
  check_case_refused(replaced(good_case, "[[load]]", ball + "history = { ramp = [0, 1] }\n[[load]]"),
                     7 + static_cast<int>(std::count(
                             good_case.begin(), good_case.begin() + long(good_case.find("[[load]]")), '\n')),
                     "tool[0].history", {"a static case has no time"});
}

TEST_CASE("a measure of a tool is refused in a case without one") {
  check_case_refused(
      replaced(good_case, "kind = 'tilt'", "kind = 'penetration'\ntool = 'ball'"),
      2 + static_cast<int>(
              std::count(good_case.begin(), good_case.begin() + long(good_case.find("kind = 'tilt'")), '\n')),
      "measure[0].tool", {"the case has none"});
}
