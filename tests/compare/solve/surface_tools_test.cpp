// Tools that are the closed surfaces of files, in both models.

#include <fmt/format.h> // first: fmt 9 calls an unqualified compare()

#include "cases/scene/fields.hpp"
#include "compare/interact/simulation.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/solve/solve.hpp"
#include "compare/solve/springs.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/tool_surfaces.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace springproof;

using namespace compare;
using Catch::Matchers::Contains;
using Eigen::Vector3d;

namespace {

/// A quarter of a block of 12 x 12 x 8 mm.
std::string quarter_under(const std::string& tool, const std::string& dynamics = "",
                          const std::string& cells = "[6, 6, 4]") {
  return fmt::format("schema = 1\nname = 'block'\n[body]\nshape = 'box'\nsize = [12, 12, 8]\n"
                     "cells = {}\n[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.01\n"
                     "poissons_ratio = 0.3\n{}[[symmetry]]\nplane = 'x-'\n[[symmetry]]\nplane = 'y-'\n"
                     "[[fixed]]\nregion = 'z-'\n[[tool]]\nname = 'tool'\n{}{}"
                     "[fem]\nformulation = 'log_strain'\nelement = 'q1'\naccuracy = 'none'\n"
                     "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'tool'\ncomponent = 'z'\n",
                     cells, dynamics.empty() ? "" : "density = 1000\n", tool, dynamics);
}

/// @param surface  of the file tool.stl
cases::Scene scene_with_file(const std::string& text, const cases::Surface& surface) {
  const TemporaryFolder folder;
  folder.write("tool.stl", tool_surfaces::stl(surface));
  return cases::make_scene(cases::read_case(folder.write("case.toml", text)));
}

/// What the tool does to springs and to elements.
std::array<cases::ToolContact, 2> pressed_by_surface(const cases::Scene& scene) {
  std::optional<msm::DesignResult> design;
  const Answer springs = solve_springs(scene, 1, design), elements = solve_fem_as_given(scene);
  INFO(springs.solution.message << elements.solution.message);
  REQUIRE(springs.converged());
  REQUIRE(elements.converged());
  return {springs.solution.tools.front(), elements.solution.tools.front()};
}

const std::string of_file = "shape = 'surface'\nfile = 'tool.stl'\n";
const std::string goes_down = "displacement = [0, 0, -1.5]\n";

} // namespace

TEST_CASE("a ball of triangles presses as balls about and within it do, and tends to the sphere",
          "[verification]") {
  const auto sphere = [&](double radius) {
    return pressed_by_surface(cases::make_scene(case_text::read_text(quarter_under(
        fmt::format("shape = 'sphere'\ncentre = [0, 0, 18]\nradius = {:.17g}\n", radius) + goes_down))));
  };
  const auto exact = sphere(10);
  std::array<double, 2> coarse{}, fine{};
  for (const int n : {8, 32}) {
    const cases::Surface ball = tool_surfaces::ball(10, n);
    const double depth = tool_surfaces::sagitta(ball, 10);
    const auto within = sphere(10 - depth),
               found = pressed_by_surface(
                   scene_with_file(quarter_under(of_file + "centre = [0, 0, 18]\n" + goes_down), ball));
    for (std::size_t model = 0; model < 2; ++model) {
      INFO("n = " << n << ", model " << model << ": " << within[model].force.z() << " "
                  << found[model].force.z() << " " << exact[model].force.z() << ", sagitta " << depth);
      CHECK(-found[model].force.z() > -within[model].force.z());
      CHECK(-found[model].force.z() < -exact[model].force.z());
      (n == 8 ? coarse : fine)[model] = 1 - found[model].force.z() / exact[model].force.z();
      CHECK(found[model].penetration < 1e-3 * 1.5);
    }
  }
  for (std::size_t model = 0; model < 2; ++model)
    CHECK(fine[model] < coarse[model] / 8); // triangles are a quarter as long; 16 by their second order
}

TEST_CASE("a box's face presses, rubs and moves as the plane that it lies in", "[verification]") {
  const cases::Surface box = tool_surfaces::box({-20, -20, 0}, {20, 20, 30});
  const std::string plane = "shape = 'plane'\npoint = [0, 0, 8]\nnormal = [0, 0, -1]\n",
                    placed = of_file + "centre = [0, 0, 8]\n";
  const std::pair<std::string, std::string> ways[] = {
      {"displacement = [0, 0, -0.5]\n", ""},
      {"displacement = [0.5, 0, -0.5]\nfriction = 0.3\nsteps = 2\n", ""},
      {"displacement = [0, 0, -0.5]\nfriction = 0.3\nhistory = { ramp = [0, 0.2] }\n",
       "[dynamics]\nscheme = 'implicit_euler'\nstep = 0.05\nend = 0.2\n"}};
  for (const auto& [way, dynamics] : ways) {
    const auto by_plane = pressed_by_surface(cases::make_scene(
                   case_text::read_text(quarter_under(plane + way, dynamics, "[3, 3, 2]")))),
               by_box = pressed_by_surface(
                   scene_with_file(quarter_under(placed + way, dynamics, "[3, 3, 2]"), box));
    INFO(way);
    for (std::size_t model = 0; model < 2; ++model) {
      CHECK(by_plane[model].force.z() < -0.1);
      CHECK((by_box[model].force - by_plane[model].force).norm() < 1e-9 * by_plane[model].force.norm());
      CHECK((by_box[model].torque - by_plane[model].torque).norm() < 1e-9 * by_plane[model].torque.norm());
      CHECK(by_box[model].area == Approx(by_plane[model].area).epsilon(1e-9));
    }
  }
}

TEST_CASE("a tool's file is in its unit and its place, part of what results are kept by, and drawn") {
  const std::string given = quarter_under(of_file + "scale = 1000\ncentre = [0, 0, 18]\n" + goes_down);
  const cases::Scene scene = scene_with_file(given, tool_surfaces::ball(0.01, 2));
  const auto& surface = std::get<cases::tools::Surface>(scene.definition.tools[0].shape);
  CHECK(surface.triangles.size() == 32);
  for (const Vector3d& vertex : surface.vertices) CHECK(vertex.norm() == Approx(10));
  CHECK(scene.definition.tools[0].place(1) == Vector3d(0, 0, 16.5));
  CHECK_THAT(*reason_without_calculix(scene.definition), Contains("\"tool\" is a surface of a file"));
  CHECK(std::get<cases::tools::Surface>(cases::make_scene(scene.definition).definition.tools[0].shape)
            .vertices == surface.vertices); // the file is gone
  const auto bytes = [](const cases::Scene& of) { return cases::to_bytes<cereal::BinaryOutputArchive>(of); };
  CHECK(bytes(scene) == bytes(scene_with_file(given, tool_surfaces::ball(0.01, 2))));
  CHECK(bytes(scene) != bytes(scene_with_file(given, tool_surfaces::ball(0.011, 2))));
  const auto drawn = [](int n) {
    cases::Scene in_time = scene_with_file(
        quarter_under(of_file + "centre = [0, 0, 18]\n" + goes_down + "history = { ramp = [0, 0.2] }\n",
                      "[dynamics]\nscheme = 'implicit_euler'\nstep = 0.05\nend = 0.2\n"),
        tool_surfaces::ball(10, n));
    Simulation simulation(in_time, {}, [](const auto&) {});
    return nlohmann::json::parse(simulation.description())["tools"][0];
  };
  CHECK(drawn(2)["vertices"].size() == 3 * 18);
  CHECK(drawn(2)["triangles"].size() == 3 * 32);
  CHECK(drawn(32)["triangles"].size() <= 3 * 5000);
}

TEST_CASE("a tool's file that is none, or bounds nothing, is refused at its name") {
  const TemporaryFolder folder;
  const std::string text = quarter_under(of_file + goes_down);
  const auto refused = [&](const std::string& stl, const std::string& says) {
    folder.write("tool.stl", stl);
    CHECK_THROWS_WITH(cases::make_scene(cases::read_case(folder.write("case.toml", text))),
                      Contains("case.toml:") && Contains("tool[0].file: ") && Contains("tool.stl") &&
                          Contains(says));
  };
  refused("no surface", "Expecting 'solid'");
  cases::Surface open = tool_surfaces::ball(10, 2);
  open.pop_back();
  refused(tool_surfaces::stl(open), "is open: 3 of its edges");
  refused(case_text::replaced(tool_surfaces::stl(open), "vertex 0 0 10", "vertex 0 0 nan"), "not finite");
}
