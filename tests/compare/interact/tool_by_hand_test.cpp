// A tool that a hand moves, and its recording in both models.

#include "cases/case/read_case.hpp"
#include "compare/interact/pulled_body.hpp"
#include "compare/interact/recording.hpp"
#include "compare/interact/simulation.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <sstream>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

/// @param cells  [9, 9, 7] and more move by multigrid
cases::Scene block_and_ball(const std::string& cells, const std::string& of_msm = "") {
  return cases::make_scene(cases::read_case_text(fmt::format(R"(schema = 1
name = "block"
[body]
shape = "box"
size = [36, 36, 24]
cells = {}
[material]
model = "linear_elastic"
youngs_modulus = 0.01
poissons_ratio = 0.3
density = 1000
mass_damping = 20
[[fixed]]
region = "z-"
[[load]]
kind = "gravity"
value = [0, 0, -1e-9]
[[tool]]
name = "ball"
shape = "sphere"
centre = [18, 18, 35]
radius = 10
[dynamics]
scheme = "implicit_euler"
step = 0.02
end = 0.4
[fem]
accuracy = "none"
[msm]
design = "hybrid"
{}
[[measure]]
name = "force"
kind = "tool_force"
tool = "ball"
component = "z"
)",
                                                             cells, of_msm),
                                                 "block.toml"));
}

/// Where a hand has the ball at the end of a step, less where it begins, mm: down, and then along the
/// surface.
Vector3d way(int step) {
  return {0.3 * std::max(0, step - 10), 0, -0.3 * std::min(step, 12)};
}

} // namespace

TEST_CASE("a tool that a hand moves presses the springs, and both models replay it", "[verification][long]") {
  for (const std::string cells : {"[6, 6, 4]", "[12, 12, 8]"}) {
    CAPTURE(cells);
    const cases::Scene scene = block_and_ball(cells);
    PulledBody body(scene, {50, 1e-4, 1});
    body.step();
    CHECK(body.tools().at(0).contact.force == Vector3d::Zero());
    body.grab_tool(0);
    CHECK(body.held_tool() == std::optional<std::size_t>(0));
    std::string recording = tool_recording_header + "\n1,0.02,0,18,18,35\n";
    std::vector<double> forces{0, 0};
    for (int step = 2; step <= 20; ++step) {
      body.drag(way(step));
      body.step();
      const auto& [at, contact] = body.tools()[0];
      CHECK((at - Vector3d(18, 18, 35) - way(step)).norm() < 1e-12);
      recording +=
          fmt::format("{},{:.17g},0,{:.17g},{:.17g},{:.17g}\n", step, step * 0.02, at.x(), at.y(), at.z());
      forces.push_back(contact.force.z());
    }
    REQUIRE(body.troubles().n_failures == 0);
    CHECK(forces.back() < -0.01); // N

    const cases::Scene replayed = with_recording(scene, recording, "tools.csv");
    std::optional<msm::DesignResult> design;
    const Answer springs = solve_springs(replayed, 1, design), elements = solve_fem_as_given(replayed);
    INFO(springs.solution.message << elements.solution.message);
    REQUIRE(springs.converged());
    REQUIRE(elements.converged());
    const auto &of_springs = springs.solution.trajectory->tools,
               &of_elements = elements.solution.trajectory->tools;
    REQUIRE(of_springs.size() == forces.size());
    for (std::size_t step = 0; step < forces.size(); ++step)
      CHECK(std::abs(of_springs[step].force.z() - forces[step]) <= 1e-3 * std::abs(forces.back()));
    CHECK(of_elements.back().force.z() == Approx(forces.back()).epsilon(0.2)); // as far apart as models are
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < scene.mesh.nodes.size(); ++n) {
      largest = std::max(largest, body.displacement()[n].norm());
      difference = std::max(difference, (body.displacement()[n] - springs.solution.displacement[n]).norm());
    }
    CHECK(largest > 1);
    CHECK(difference < 1e-3 * largest);
  }
}

TEST_CASE("tools stay where they are in a replay of pulls, as they did beside them") {
  cases::Scene scene = block_and_ball("[3, 3, 2]");
  scene.definition.tools.front().displacement = {0, 0, -5};
  scene.definition.tools.front().history.points = {{0, 0}, {0.4, 1}};
  const cases::Scene replayed =
      with_recording(scene, "step,time,x,y,z,radius,fx,fy,fz\n2,0.04,18,18,24,20,0,0,1e-6\n", "pulls.csv");
  CHECK(scene.definition.tools.front().place(0.4).z() == Approx(30));
  CHECK(replayed.definition.tools.front().place(0.4) == Vector3d(18, 18, 35));
}

TEST_CASE("a tool goes no further in a step than a fiftieth of the body, and back to where it begins") {
  const cases::Scene scene = block_and_ball("[3, 3, 2]");
  PulledBody body(scene, {50, 1e-4, 1});
  body.grab_tool(0);
  body.drag({0, 0, -8});
  body.step();
  CHECK(body.tools()[0].at.z() == Approx(35 - 0.02 * Vector3d(36, 36, 24).norm()));
  body.release();
  const Vector3d left = body.tools()[0].at;
  body.step();
  CHECK(body.tools()[0].at == left);
  body.restart();
  CHECK(body.tools()[0].at == Vector3d(18, 18, 35));
  body.grab_tool(7); // there is none
  CHECK_FALSE(body.held_tool());
}

TEST_CASE("methods of simulators are not moved beside a tool, and a recording of tools is checked") {
  const cases::Scene stepped = [] {
    cases::Scene scene = block_and_ball("[3, 3, 2]");
    scene.definition.msm.real_time.emplace();
    return scene;
  }();
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH(PulledBody(stepped, {}), Contains("must be left out beside a method of simulators"));
  const cases::Scene scene = block_and_ball("[3, 3, 2]");
  const auto refused = [&](const std::string& rows, const std::string& says) {
    CHECK_THROWS_WITH(with_recording(scene, tool_recording_header + "\n" + rows, "tools.csv"),
                      Contains(says));
  };
  refused("", "moves no tool");
  refused("1,0.02,0,18,18\n", "six numbers");
  refused("1,0.02,1,18,18,35\n", "the case, which has 1");
  refused("1,0.03,0,18,18,35\n", "time is 0.03 s");
  refused("1.5,0.03,0,18,18,35\n", "whole number");
  refused("2,0.04,0,18,18,35\n2,0.04,0,18,18,34\n", "above that of the tool's line before");
  refused("30,0.6,0,18,18,35\n", "dynamics.end is 0.4 s");
  const cases::Scene led =
      with_recording(scene, tool_recording_header + "\n0,0,0,18,18,35\n1,0.02,0,18,18,34\n", "tools.csv");
  CHECK(led.definition.tools[0].place(0.01).z() == Approx(34.5));
}

TEST_CASE("a page takes a tool by its number") {
  CHECK(std::get<GrabTool>(message_from(R"({"type": "grab_tool", "tool": 1})").value()).tool == 1);
  for (const std::string text :
       {R"({"type": "grab_tool"})", R"({"type": "grab_tool", "tool": -1})",
        R"({"type": "grab_tool", "tool": 0.5})", R"({"type": "grab_tool", "tool": "ball"})",
        R"({"type": "grab_tool", "tool": 0, "x": 1})"}) {
    CAPTURE(text);
    CHECK_FALSE(message_from(text));
  }
}
