// Bodies that rigid tools press, in both models.

#include <fmt/format.h> // first: fmt 9 calls an unqualified compare()

#include "compare/export/export_springs.hpp"
#include "compare/gates/comparison.hpp"
#include "compare/modes/modes.hpp"
#include "compare/peers/getfem.hpp"
#include "compare/solve/solve.hpp"
#include "compare/write/write.hpp"
#include "msm/model.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

using namespace springproof;

using namespace compare;

namespace {

/// A block of 4 x 4 x 3 cells of 1 mm on rollers, free to widen. Measures: what its floor bears, and what the
/// tool named "tool" does.
std::string block(const std::string& acts, const std::string& element = "q1",
                  const std::string& shape = "shape = 'box'\nsize = [4, 4, 3]\ncells = [4, 4, 3]\n") {
  return fmt::format("schema = 1\nname = 'block'\n[body]\n{}[material]\nmodel = 'linear_elastic'\n"
                     "youngs_modulus = 0.01\npoissons_ratio = 0.3\n"
                     "[[symmetry]]\nplane = 'x-'\n[[symmetry]]\nplane = 'y-'\n"
                     "[[fixed]]\nregion = 'z-'\ncomponents = ['z']\n{}"
                     "[fem]\nformulation = 'log_strain'\nelement = '{}'\naccuracy = 'none'\n"
                     "[[measure]]\nname = 'floor'\nkind = 'reaction'\nregion = 'z-'\ncomponent = 'z'\n",
                     shape, acts, element);
}

const std::string of_tool =
    "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'tool'\ncomponent = 'z'\n"
    "[[measure]]\nname = 'torque'\nkind = 'tool_torque'\ntool = 'tool'\ncomponent = 'y'\n"
    "[[measure]]\nname = 'area'\nkind = 'contact_area'\ntool = 'tool'\n"
    "[[measure]]\nname = 'depth'\nkind = 'penetration'\ntool = 'tool'\n";

std::string plane(double down) {
  return fmt::format("[[tool]]\nname = 'tool'\nshape = 'plane'\npoint = [0, 0, 3]\nnormal = [0, 0, -1]\n"
                     "displacement = [0, 0, {}]\n",
                     -down);
}

/// Both models' values of a measure.
struct Both {
  double fem, msm;
};
Both value(const Comparison& comparison, const std::string& measure) {
  for (const MeasuredValue& found : comparison.measures)
    if (found.name == measure) return {found.fem.value(), found.msm.value()};
  FAIL("no measure " + measure);
  return {};
}

Comparison compared(const std::string& text) {
  Comparison comparison = compare_case(case_text::read_text(text), {});
  INFO(comparison.answers.fem.solution.message << comparison.answers.msm.solution.message);
  REQUIRE(comparison.answers.fem.converged());
  REQUIRE(comparison.answers.msm.converged());
  return comparison;
}

} // namespace

TEST_CASE("a plane that presses a block does what the same motion of its top does", "[verification]") {
  for (const char* element : {"q1", "q1_bbar", "q1_p0", "q2"}) {
    const Comparison tool = compared(block(plane(0.3), element) + of_tool),
                     moved = compared(block("[[moved]]\nregion = 'z+'\ncomponents = ['z']\n"
                                            "displacement = [0, 0, -0.3]\n",
                                            element));
    INFO(element);
    // The surface may be a thousandth of 0.3 mm from the plane.
    CHECK(value(tool, "floor").fem == Approx(value(moved, "floor").fem).epsilon(2e-3));
    CHECK(value(tool, "floor").msm == Approx(value(moved, "floor").msm).epsilon(2e-3));
    for (const auto& [force, floor] : {std::pair(value(tool, "force").fem, value(tool, "floor").fem),
                                       std::pair(value(tool, "force").msm, value(tool, "floor").msm)})
      CHECK(force == Approx(-floor).epsilon(1e-6)); // what supports bear is checked to that at every node
    CHECK(value(tool, "area").fem == Approx(16));
    CHECK(value(tool, "area").msm == Approx(16));
    CHECK(value(tool, "depth").fem <= 1e-3 * 0.3);
    CHECK(value(tool, "depth").msm <= 1e-3 * 0.3);
    // Free sides in logarithmic strains widen by e_x = -nu e_z: the pressure's centre is in their middle.
    const double middle = 2 * std::pow(0.9, -0.3); // mm
    CHECK(value(tool, "torque").fem / -value(tool, "force").fem == Approx(middle).epsilon(1e-3));
  }
}

TEST_CASE("a tool that nothing touches changes nothing, and two tools pinch", "[verification]") {
  const std::string load = "[[load]]\nregion = 'z+'\nkind = 'traction'\nvalue = [0, 0, -0.0005]\n";
  const std::string far = "[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [2, 2, 30]\nradius = 4\n";
  const Comparison alone = compared(block(load)), beside = compared(block(load + far) + of_tool);
  CHECK(value(beside, "floor").fem == Approx(value(alone, "floor").fem).epsilon(1e-9));
  CHECK(value(beside, "floor").msm == Approx(value(alone, "floor").msm).epsilon(1e-9));
  CHECK(value(beside, "force").fem == 0);
  CHECK(value(beside, "area").msm == 0);
}

TEST_CASE("what every tool does to a block is borne by its floor", "[verification]") {
  const std::string shapes[] = {"shape = 'sphere'\ncentre = [0, 0, 6]\nradius = 3\n",
                                "shape = 'cylinder'\ncentre = [0, 0, 6]\nradius = 3\naxis = 'y'\n",
                                "shape = 'punch'\ncentre = [0, 0, 3]\nradius = 2.4\naxis = [0, 0, -1]\n"};
  for (const std::string& shape : shapes) {
    INFO(shape);
    const Comparison found =
        compared(block("[[tool]]\nname = 'tool'\n" + shape + "displacement = [0, 0, -0.4]\n") + of_tool);
    for (const auto& [force, floor] : {std::pair(value(found, "force").fem, value(found, "floor").fem),
                                       std::pair(value(found, "force").msm, value(found, "floor").msm)}) {
      CHECK(force < 0);
      CHECK(force == Approx(-floor).epsilon(1e-6));
    }
    // One law on one mesh: the models differ as they do without tools, by some percent.
    CHECK(value(found, "force").msm == Approx(value(found, "force").fem).epsilon(0.2));
    CHECK(value(found, "depth").fem <= 1e-3 * 0.4);
    CHECK(value(found, "depth").msm <= 1e-3 * 0.4);
  }
}

TEST_CASE(
    "a punch that one load step takes deeper than nodes are from its rim presses them as short steps do",
    "[verification]") {
  const auto pressed = [](int steps) {
    return compared(
        block(fmt::format("[[tool]]\nname = 'tool'\nshape = 'punch'\ncentre = [0, 0, 3]\nradius = 2.4\n"
                          "axis = [0, 0, -1]\ndisplacement = [0, 0, -0.8]\nsteps = {}\n",
                          steps)) +
        of_tool);
  };
  // Nodes are 0.16 and 0.4 mm from the rim.
  const Comparison once = pressed(1), often = pressed(16);
  // The surface may be a thousandth of 0.8 mm from the punch.
  CHECK(value(once, "force").fem == Approx(value(often, "force").fem).epsilon(2e-3));
  CHECK(value(once, "force").msm == Approx(value(often, "force").msm).epsilon(2e-3));
  CHECK(value(once, "area").fem == value(often, "area").fem);
  CHECK(value(once, "area").msm == value(often, "area").msm);
}

TEST_CASE("tetrahedra are pressed as the same motion of their top presses them", "[verification]") {
  using cases::Element;
  for (const Element element : {Element::p1, Element::p2, Element::p2_p1})
    for (const int refine : {0, 1}) {
      if (refine > 0 && element != Element::p1) continue; // p1 shows that finer meshes have the tool
      const auto floor = [&](const std::string& acts) {
        cases::Case definition = case_text::read_text(block(acts));
        definition.fem.refine = refine;
        const cases::Scene scene = tetrahedra::make_scene(definition, element);
        const Answer answer = solve_fem_as_given(scene);
        INFO(answer.solution.message);
        REQUIRE(answer.converged());
        double sum = 0;
        for (const int node : cases::select(scene.mesh, {"z-"}).nodes)
          sum += answer.solution.fields->reaction[cases::index(node)].z();
        if (!answer.solution.tools.empty())
          CHECK(answer.solution.tools.front().force.z() == Approx(-sum).epsilon(1e-6));
        return sum;
      };
      INFO(cases::name_of(element) << " refined " << refine);
      CHECK(floor(plane(0.3)) ==
            Approx(floor("[[moved]]\nregion = 'z+'\ncomponents = ['z']\ndisplacement = [0, 0, -0.3]\n"))
                .epsilon(2e-3));
    }
}

TEST_CASE("a body that a tool is moved against is pressed as by a tool that is moved against it",
          "[verification]") {
  const std::string lifted = "[[moved]]\nregion = 'z-'\ncomponents = ['z']\ndisplacement = [0, 0, 0.3]\n";
  std::string text = block(lifted + plane(0), "q1") + of_tool;
  text = case_text::replaced(text, "[[fixed]]\nregion = 'z-'\ncomponents = ['z']\n", "");
  const Comparison up = compared(text), down = compared(block(plane(0.3)) + of_tool);
  CHECK(value(up, "force").fem == Approx(value(down, "force").fem).epsilon(2e-3));
  CHECK(value(up, "force").msm == Approx(value(down, "force").msm).epsilon(2e-3));
}

TEST_CASE("a tool that begins inside a body presses it as one that comes from outside", "[verification]") {
  const auto pressed = [](double from, double down) {
    return compared(
        block(fmt::format("[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [0, 0, {}]\nradius = "
                          "3\ndisplacement = [0, 0, {}]\n",
                          from, -down)) +
        of_tool);
  };
  const Comparison inside = pressed(5.8, 0.2), outside = pressed(6, 0.4);
  CHECK(value(inside, "force").fem == Approx(value(outside, "force").fem).epsilon(1e-3));
  CHECK(value(inside, "force").msm == Approx(value(outside, "force").msm).epsilon(1e-3));
}

TEST_CASE("how far a body is carried with its tool does not change what the tool does", "[verification]") {
  const auto pressed = [](double carried) {
    std::string text =
        block(fmt::format("[[moved]]\nregion = 'z-'\ncomponents = ['z']\ndisplacement = [0, 0, {}]\n"
                          "[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [0, 0, 6]\nradius = 3\n"
                          "displacement = [0, 0, {}]\n",
                          -carried, -carried - 0.05)) +
        of_tool;
    return compared(case_text::replaced(text, "[[fixed]]\nregion = 'z-'\ncomponents = ['z']\n", ""));
  };
  const Comparison here = pressed(0), far = pressed(20);
  CHECK(value(far, "force").fem == Approx(value(here, "force").fem).epsilon(2e-3));
  CHECK(value(far, "force").msm == Approx(value(here, "force").msm).epsilon(2e-3));
  CHECK(value(far, "depth").fem < 0.01 * 0.05);
  CHECK(value(far, "depth").msm < 0.01 * 0.05);
}

TEST_CASE("a tool that only just touches a body settles", "[verification]") {
  // In double precision its surface is 1e-17 mm inside the block's.
  const std::string text =
      block("[[load]]\nregion = 'x+'\nkind = 'traction'\nvalue = [-0.001, 0, 0]\n"
            "[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [0.4, 0.4, 0.9]\nradius = 0.1\n",
            "q1", "shape = 'box'\nsize = [0.8, 0.8, 0.8]\ncells = [4, 4, 4]\n");
  CHECK(value(compared(text + of_tool), "force").fem < 0);
}

TEST_CASE("a tool that touches nothing is told of, and one that does is not") {
  const auto warns = [](double from) {
    const auto all = warnings_of(
        compared(block(fmt::format("[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [0, 0, {}]\nradius = "
                                   "3\ndisplacement = [0, 0, -0.2]\n",
                                   from))));
    return std::any_of(all.begin(), all.end(), [](const std::string& warning) {
      return warning.find("the tool 'tool' touches nothing") != std::string::npos;
    });
  };
  CHECK(warns(60));
  CHECK_FALSE(warns(6));
}

TEST_CASE("a tool that is thinner than the faces it may touch is told of") {
  const auto warns = [](double radius) {
    const std::string text = fmt::format("[[tool]]\nname = 'tool'\nshape = 'sphere'\ncentre = [0, 0, {}]\n"
                                         "radius = {}\ndisplacement = [0, 0, -0.2]\n",
                                         3 + radius, radius);
    Comparison comparison;
    comparison.scene = cases::make_scene(case_text::read_text(block(text)));
    const auto all = warnings_of(comparison);
    return std::any_of(all.begin(), all.end(), [](const std::string& warning) {
      return warning.find("the tool 'tool' has a radius of") != std::string::npos;
    });
  };
  CHECK(warns(0.3));
  CHECK_FALSE(warns(3));
}

TEST_CASE("what knows no tools refuses a case with one, or says why it is skipped") {
  const cases::Case definition = case_text::read_text(block(plane(0.3)));
  const cases::Scene scene = cases::make_scene(definition);
  using Catch::Matchers::Contains;
  CHECK_THROWS_WITH(exported_problem(scene), Contains("tool[0]: must be left out beside export"));
  CHECK_THROWS_WITH(study_vibrations(scene, {}, 1), Contains("tool[0]: must be left out beside eigen"));
  CHECK_THROWS_WITH(msm::Model(scene, msm::SpringBody{}, {msm::Path::multigrid}),
                    Contains("a case without tools"));
  CHECK(reason_without_getfem(scene) ==
        "[[tool]] \"tool\" presses on the body, and its input has no contact");
}
