// Rigid tools in CalculiX's input, and (label peer, which needs ccx) its contact against ours.

#include <fmt/format.h> // first: fmt 9 calls an unqualified compare()

#include "compare/gates/comparison.hpp"
#include "compare/peers/calculix.hpp"
#include "compare/peers/calculix_tool.hpp"
#include "compare/solve/solve.hpp"
#include "mechanics/contact/signed_distance.hpp"
#include "tests/support/case_text.hpp"
#include "tests/support/largest.hpp"
#include "tests/support/scene_in_tetrahedra.hpp"

#include <catch2/catch.hpp>
#include <set>
#include <sstream>

using namespace springproof;

using namespace compare;
using Eigen::Vector3d;

namespace {

/// A quarter of a block on a floor that holds it, under a tool.
std::string pressed(const std::string& tool, const std::string& formulation,
                    const std::string& element = "q1") {
  return fmt::format(
      "schema = 1\nname = 'block'\n[body]\nshape = 'box'\nsize = [12, 12, 8]\ncells = [6, 6, 4]\n"
      "[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.01\npoissons_ratio = 0.3\n"
      "[[symmetry]]\nplane = 'x-'\n[[symmetry]]\nplane = 'y-'\n[[fixed]]\nregion = 'z-'\n"
      "[[tool]]\nname = 'tool'\n{}"
      "[fem]\nformulation = '{}'\nelement = '{}'\naccuracy = 'none'\n"
      "[[measure]]\nname = 'force'\nkind = 'tool_force'\ntool = 'tool'\ncomponent = 'z'\n"
      "[[measure]]\nname = 'torque'\nkind = 'tool_torque'\ntool = 'tool'\ncomponent = 'x'\n"
      "[[measure]]\nname = 'area'\nkind = 'contact_area'\ntool = 'tool'\n"
      "[[measure]]\nname = 'depth'\nkind = 'penetration'\ntool = 'tool'\n",
      tool, formulation, element);
}

const std::string
    plane = "shape = 'plane'\npoint = [0, 0, 8]\nnormal = [0, 0, -1]\ndisplacement = [0, 0, -0.8]\n",
    sphere = "shape = 'sphere'\ncentre = [0, 0, 18]\nradius = 10\ndisplacement = [0, 0, -1.5]\n",
    cylinder = "shape = 'cylinder'\ncentre = [0, 0, 18]\nradius = 10\naxis = [0.6, 0.8, 0]\n"
               "displacement = [0, 0, -1.5]\n",
    punch = "shape = 'punch'\ncentre = [0, 0, 8]\nradius = 5\naxis = [0, 0, -1]\n"
            "displacement = [0, 0, -0.8]\n";

constexpr double size = 12;    ///< mm, of the block
constexpr double bound = 0.01; ///< for forces, and for displacements over the largest

/// Largest distance of two displacements of a node over the largest displacement.
double apart(const cases::Solution& ours, const cases::Solution& theirs) {
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < ours.displacement.size(); ++n) {
    largest = larger(largest, ours.displacement[n].norm());
    difference = larger(difference, (ours.displacement[n] - theirs.displacement[n]).norm());
  }
  return difference / largest;
}

void check_contact_agrees(const std::string& text) {
  const cases::Scene scene = tetrahedra::make_scene(case_text::read_text(text));
  const cases::Solution theirs = solve_with_calculix(scene);
  if (theirs.status == cases::Status::skipped) {
    WARN(theirs.message << ": nothing was compared");
    return;
  }
  const Answer ours = solve_fem_as_given(scene);
  INFO(ours.solution.message);
  REQUIRE(ours.converged());
  const cases::ToolContact &here = ours.solution.tools.front(), &there = theirs.tools.front();
  INFO("force " << here.force.z() << " N, CalculiX " << there.force.z() << " N");
  INFO("displacements apart by " << apart(ours.solution, theirs));
  CHECK(here.force.z() < 0);
  CHECK((there.force - here.force).norm() <= bound * here.force.norm());
  // a sphere's is none about its middle
  CHECK((there.torque - here.torque).norm() <= bound * here.force.norm() * size);
  CHECK(apart(ours.solution, theirs) <= bound);
  CHECK(there.area == Approx(here.area).epsilon(bound)); // the pressed nodes'
}

/// Numbers of cells and their sides under a card, up to the next one.
std::set<std::string> lines_below(const std::string& input, const std::string& card) {
  std::istringstream in(input);
  std::set<std::string> lines;
  bool is_there = false;
  for (std::string line; std::getline(in, line);) {
    if (line[0] == '*')
      is_there = line == card;
    else if (is_there)
      lines.insert(line);
  }
  return lines;
}

std::string input_of(const cases::Scene& scene) {
  std::ostringstream out;
  write_calculix_input(out, scene);
  return out.str();
}

} // namespace

TEST_CASE("a surface that a tool may touch is told by CalculiX's numbers of sides") {
  const auto text = [](const std::string& region) {
    return case_text::replaced(pressed(plane + "region = '" + region + "'\n", "small_strain"), "[6, 6, 4]",
                               "[1, 1, 1]");
  };
  const std::pair<const char*, const char*> sides[] = {{"z+", "1, S2"}, {"y+", "1, S5"}, {"x+", "1, S4"}};
  for (const auto& [region, side] : sides)
    CHECK(lines_below(input_of(cases::make_scene(case_text::read_text(text(region)))),
                      "*SURFACE, NAME=BODY0") == std::set<std::string>{side});
}

TEST_CASE("all vertices of a tool's facets lie on it, and their middles near enough to it") {
  for (const std::string& tool : {plane, sphere, cylinder, punch}) {
    const cases::Scene scene = cases::make_scene(case_text::read_text(pressed(tool, "small_strain")));
    const cases::Tool& it = scene.definition.tools.front();
    const ToolMesh mesh = mesh_of_tool(scene, it);
    INFO(tool);
    REQUIRE_FALSE(mesh.cells.empty());
    const mechanics::DistanceAt distance = mechanics::distance_from(it.shape);
    double furthest = 0, lowest = 0;
    for (const auto& cell : mesh.cells) {
      Vector3d middle = Vector3d::Zero();
      for (std::size_t v = 0; v < 4; ++v) {
        const Vector3d from = mesh.nodes[static_cast<std::size_t>(cell[v])] - it.at;
        furthest = larger(furthest, std::abs(distance(from).value));
        middle += from / 4;
      }
      lowest = std::min(lowest, distance(middle).value);
    }
    CHECK(furthest <= 1e-12);
    CHECK(lowest >= -1.5e-3); // a thousandth of the deepest indentation
  }
}

TEST_CASE("a tool that only touches has facets, and one that is barely pressed in is refused") {
  const auto facets = [](double way) {
    cases::Scene scene = cases::make_scene(case_text::read_text(pressed(sphere, "small_strain")));
    cases::Tool tool = scene.definition.tools.front();
    tool.displacement = {0, 0, -1};
    const auto& ball = std::get<cases::tools::Sphere>(tool.shape);
    tool.at[2] = cases::bounding_box(scene.mesh.nodes).max()[2] + ball.radius + 1 - way;
    return mesh_of_tool(scene, tool);
  };
  CHECK_FALSE(facets(1e-16).cells.empty());
  CHECK_THROWS_WITH(facets(1e-6), Catch::Contains("is pressed in so little, 1e-06 mm"));
}

TEST_CASE("what CalculiX's contact is not for is refused by name") {
  const auto reason = [](const std::string& text) {
    return reason_without_calculix(case_text::read_text(text));
  };
  CHECK_FALSE(reason(pressed(sphere, "small_strain")));
  CHECK(reason(pressed(sphere, "small_strain", "q2")) ==
        "its contact of nodes with tools is for elements q1 and p1, not q2");
  CHECK(reason(pressed(sphere + "friction = 0.3\n", "small_strain")) ==
        "[[tool]] \"tool\" has friction, and its input has none");
  const std::string motion =
      case_text::replaced(pressed(sphere + "history = { sine = 1 }\n", "small_strain"),
                          "poissons_ratio = 0.3\n", "poissons_ratio = 0.3\ndensity = 1000\n");
  CHECK(reason(motion + "over_time = 'peak'\n[dynamics]\nscheme = 'bdf2'\nstep = 0.01\nend = 0.1\n") ==
        "[[tool]] \"tool\" moves in time, and its contact is at rest");
}

TEST_CASE("the forces of a .dat file are those on the tools' nodes, in newtons") {
  std::istringstream dat(R"(
 forces (fx,fy,fz) for set NTOOL0 and time  0.1000000E+01

         3  1.000000E+06  0.000000E+00 -2.000000E+06

 displacements (vx,vy,vz) for set NALL and time  0.1000000E+01

         1  9.000000E+00  9.000000E+00  9.000000E+00
         3  9.000000E+00  9.000000E+00  9.000000E+00

 forces (fx,fy,fz) for set NTOOL1 and time  0.1000000E+01

         4  0.000000E+00  5.000000E+05  0.000000E+00
)");
  const std::vector<Vector3d> forces = read_calculix_tool_forces(dat, 2);
  REQUIRE(forces.size() == 2);
  CHECK(forces[0] == Vector3d(1, 0, -2));
  CHECK(forces[1] == Vector3d(0, 0.5, 0));
}

TEST_CASE("planes and punches press as CalculiX's", "[peer][long]") {
  for (const std::string& tool : {plane, punch})
    for (const char* formulation : {"small_strain", "saint_venant_kirchhoff"}) {
      INFO(tool << formulation);
      check_contact_agrees(pressed(tool, formulation));
    }
}

TEST_CASE("spheres and cylinders press as CalculiX's", "[peer][long]") {
  for (const std::string& tool : {sphere, cylinder})
    for (const char* formulation : {"small_strain", "saint_venant_kirchhoff"}) {
      INFO(tool << formulation);
      check_contact_agrees(pressed(tool, formulation));
    }
}

TEST_CASE("a sphere presses tetrahedra as CalculiX's", "[peer]") {
  check_contact_agrees(pressed(sphere, "small_strain", "p1"));
}
