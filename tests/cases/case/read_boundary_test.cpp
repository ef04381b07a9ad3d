#include "cases/case/readers.hpp"

#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("a region that is moved along or turned about an axis takes the place of a load") {
  const std::string load = "[[load]]\nregion = 'z+'\nkind = 'nodal_force'\nvalue = [0.002, 0, 0.0]\n";
  SECTION("moved along") {
    const Case c = read_text(replaced(
        good_case, load, "[[moved]]\nregion = 'z+'\ncomponents = ['z']\ndisplacement = [0, 0, -5]\n"));
    CHECK(c.loads.empty());
    REQUIRE(c.moved.size() == 1);
    CHECK(c.moved[0].components == std::array<bool, 3>{false, false, true});
    CHECK(c.moved[0].displacement == Eigen::Vector3d(0, 0, -5));
    CHECK(c.moved[0].angle == 0);
  }
  SECTION("turned") {
    const Case c = read_text(
        replaced(good_case, load, "[[moved]]\nregion = 'z+'\nangle = 90\naxis = 'z'\ncentre = [5, 5, 10]\n"));
    REQUIRE(c.moved.size() == 1);
    CHECK(c.moved[0].angle == 90);
    CHECK(c.moved[0].axis == Eigen::Vector3d::UnitZ());
    CHECK(c.moved[0].centre == Eigen::Vector3d(5, 5, 10));
  }
}

TEST_CASE("a patch around a point is read") {
  const Case c = read_text(replaced(good_case, "region = 'z+'", "near = [5, 5, 10]\nradius = 2.5"));
  CHECK(c.loads[0].region.near == Eigen::Vector3d(5, 5, 10));
  CHECK(c.loads[0].region.radius == 2.5);
}

TEST_CASE("the node nearest to a point, and a patch on a plane, are read") {
  const Case nearest = read_text(replaced(good_case, "region = 'z+'", "nearest = [5, 5, 11]\ntolerance = 2"));
  CHECK(nearest.loads[0].region.near == Eigen::Vector3d(5, 5, 11));
  CHECK(nearest.loads[0].region.tolerance == 2);
  const Case plane = read_text(replaced(
      good_case, "region = 'z+'\nkind = 'nodal_force'",
      "region = { plane = { point = [0, 0, 10], normal = [0, 0, 2], tolerance = 0.1 } }\nkind = 'traction'"));
  REQUIRE(plane.loads[0].region.plane);
  CHECK(plane.loads[0].region.plane->normal == Eigen::Vector3d(0, 0, 1));
  CHECK(plane.loads[0].region.is_patch());
  const auto refused = mistakes_in(good_case);
  refused("region = 'z-'", "nearest = [0, 0, 0]", 12, "fixed[0].tolerance", {"is missing"});
  refused("region = 'z-'", "nearest = [0, 0, 0]\ntolerance = 0", 14, "fixed[0].tolerance", {"above 0"});
  refused("region = 'z-'", "region = 'z-'\ntolerance = 1", 14, "fixed[0].tolerance", {"without nearest"});
  refused("region = 'z-'", "region = 'z-'\nnearest = [0, 0, 0]\ntolerance = 1", 13, "fixed[0].region",
          {"left out beside nearest"});
  refused("region = 'z-'", "region = { plane = { point = [0, 0, 0], normal = 'x' } }", 13,
          "fixed[0].region.plane.tolerance", {"is missing"});
  refused(
      "region = 'z-'",
      "region = { plane = { point = [0, 0, 0], normal = 'x', tolerance = 1 }, box = [[0, 0, 0], [1, 1, 1]] }",
      13, "fixed[0].region.box", {"left out beside plane"});
}

TEST_CASE("a part of the body in a box or beyond a plane is read as a region") {
  const Case c = read_text(replaced(good_case, "region = 'z-'",
                                    "region = { box = [[0, 0, 0], [1, 2, 3]], beyond = { point = [1, 1, 1], "
                                    "normal = [0, 3, 4] } }"));
  const Region& region = c.fixed[0].region;
  REQUIRE(region.part);
  CHECK(region.part->cell_class.empty());
  CHECK(region.part->lower == Eigen::Vector3d(0, 0, 0));
  CHECK(region.part->upper == Eigen::Vector3d(1, 2, 3));
  CHECK(region.part->point == Eigen::Vector3d(1, 1, 1));
  CHECK((region.part->normal - Eigen::Vector3d(0, 0.6, 0.8)).norm() <= 1e-16); // rounding of 3/5
}

TEST_CASE("a mistake in a part of the body is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  refused("region = 'z-'", "region = {}", 13, "fixed[0].region", {"class, box and beyond"});
  refused("region = 'z-'", "region = 7", 13, "fixed[0].region", {"is 7"});
  refused("region = 'z-'", "region = { class = 'bone' }", 13, "fixed[0].region.class", {"classes of cells"});
  refused("region = 'z-'", "region = { bx = 1 }", 13, "fixed[0].region.bx",
          {"allowed are beyond, box, class"});
  refused("region = 'z-'", "region = { box = [[0, 0, 1], [1, 1, 0]] }", 13, "fixed[0].region.box",
          {"the lower first"});
  refused("region = 'z-'", "region = { box = [[0, 0, 1]] }", 13, "fixed[0].region.box", {"two corners"});
  refused("region = 'z-'", "region = { beyond = { point = [0, 0, 0] } }", 13, "fixed[0].region.beyond.normal",
          {"is missing"});
  refused("region = 'z-'", "region = { beyond = { point = [0, 0, 0], normal = [0, 0, 0] } }", 13,
          "fixed[0].region.beyond.normal", {"not all 0"});
  refused("region = 'z+'\nkind = 'nodal_force'",
          "region = { box = [[0, 0, 0], [9, 9, 9]] }\nkind = 'traction'", 15, "load[0].region",
          {"has no area"});
}

TEST_CASE("a mistake in [[fixed]] or [[symmetry]] is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  refused("[[fixed]]\nregion = 'z-'\n", "", 1, "fixed", {"is missing", "nothing holds the body"});
  refused("[[fixed]]", "[fixed]", 12, "fixed", {"is a table", "one or more tables [[fixed]]"});
  refused("[[fixed]]", "[[fixd]]", 12, "fixd", {"did you mean \"fixed\"?"});
  refused("region = 'z-'", "region = 'w-'", 13, "fixed[0].region", {"is \"w-\"", "a face \"x-\""});
  refused("region = 'z-'", "region = 'z- z+'", 13, "fixed[0].region", {"z- and z+ do not"});
  refused("region = 'z-'", "region = 'z- z-'", 13, "fixed[0].region", {"faces that meet"});
  refused("region = 'z-'", "region = 'near 1 2'", 13, "fixed[0].region", {"near x y z"});
  refused("region = 'z-'", "region = 'near 1 2 nan'", 13, "fixed[0].region", {"near x y z"});
  refused("region = 'z-'", "near = [1, 2]", 13, "fixed[0].near", {"three finite numbers"});
  refused("region = 'z-'", "region = 'z-'\nnear = [1, 2, 3]", 14, "fixed[0].near",
          {"left out beside region"});
  refused("region = 'z-'", "", 12, "fixed[0].region", {"is missing"});
  refused("region = 'z-'", "region = 'z-'\ncomponents = ['x', 'x']", 14, "fixed[0].components",
          {"each once"});
  refused("region = 'z-'", "region = 'z-'\ncomponents = 'x'", 14, "fixed[0].components", {"one to three of"});
  refused("[[fixed]]\nregion = 'z-'", "[[symmetry]]\nplane = 'z'", 13, "symmetry[0].plane",
          {"is \"z\"", "\"x-\" | \"x+\""});
  refused("[[fixed]]\nregion = 'z-'", "[[symmetry]]\nplane = 'z-'\n[[symmetry]]\nplane = 'z-'", 15,
          "symmetry[1].plane", {"another plane than symmetry[0]"});
}

TEST_CASE("a mistake in [[load]] is refused where it is made") {
  const std::string load = "region = 'z+'\nkind = 'nodal_force'\nvalue = [0.002, 0, 0.0]\n";
  const auto refused = mistakes_in(good_case);
  refused("[[load]]\n" + load, "", 1, "load", {"is missing", "[[load]]"});
  refused("kind = 'nodal_force'", "kind = 'nodal_farce'", 16, "load[0].kind",
          {"total_force", "did you mean \"nodal_force\"?"});
  refused("value = [0.002, 0, 0.0]", "value = [0.002, '0', 0.0]", 17, "load[0].value",
          {"three finite numbers (N)"});
  refused("value = [0.002, 0, 0.0]", "value = [0.002, 0, -inf]", 17, "load[0].value",
          {"-inf", "three finite numbers (N)"});
  refused("value = [0.002, 0, 0.0]", "value = [0, 0, 0]", 17, "load[0].value", {"other than 0"});
  refused("value = [0.002, 0, 0.0]", "vlaue = [0.002, 0, 0.0]", 17, "load[0].vlaue",
          {"did you mean \"value\"?"});
  refused("value = [0.002, 0, 0.0]", "value = [0.002, 0, 0.0]\naxis = 'z'", 18, "load[0].axis",
          {"is not a key here"});
  refused(load, "region = 'z+ x+'\nkind = 'traction'\nvalue = [1, 0, 0]\n", 15, "load[0].region",
          {"no area", "traction"});
  refused(load, "near = [10, 10, 10]\nkind = 'traction'\nvalue = [1, 0, 0]\n", 15, "load[0].near",
          {"no area"});
  refused(load, "region = 'z+'\nkind = 'torque'\nvalue = [1, 0, 0]\n", 17, "load[0].value",
          {"one finite number", "N mm"});
  refused(load, "region = 'z+'\nkind = 'torque'\nvalue = 1\naxis = 'w'\n", 18, "load[0].axis",
          {"\"x\" | \"y\" | \"z\""});
  refused(load, "region = 'z+'\nkind = 'torque'\nvalue = 1\naxis = [0,0,0]\n", 18, "load[0].axis",
          {"not all 0"});
  refused(load, "region = 'z+'\nkind = 'torque'\nvalue = 1\naxis = 'z'\n", 14, "load[0].centre",
          {"is missing"});
  // patches
  refused("region = 'z+'", "region = 'z+'\nradius = 1", 16, "load[0].radius", {"left out without near"});
  refused("region = 'z+'", "near = [5, 5, 10]\nradius = 0", 16, "load[0].radius", {"a number above 0"});
}

TEST_CASE("a mistake in [[moved]] is refused where it is made") {
  const std::string load = "region = 'z+'\nkind = 'nodal_force'\nvalue = [0.002, 0, 0.0]\n";
  const auto refused = mistakes_in(good_case);
  refused(load, "region = 'z+'\nkind = 'nodal_force'\nvalue = [1, 0, 0]\n[[moved]]\nregion = 'z+'\n", 18,
          "moved[0].displacement", {"is missing", "angle"});
  refused(load, load + "[[moved]]\nregion = 'z+'\ndisplacement = [1, 0]\n", 20, "moved[0].displacement",
          {"three finite numbers"});
  refused(load, load + "[[moved]]\nregion = 'z+'\ncomponents = ['z']\ndisplacement = [1, 0, 2]\n", 21,
          "moved[0].displacement", {"0 in the components that are not moved"});
  refused(load, load + "[[moved]]\nregion = 'z+'\ndisplacement = [1, 0, 0]\naxis = 'z'\n", 21,
          "moved[0].axis", {"left out without angle"});
  refused(load, load + "[[moved]]\nregion = 'z+'\ndisplacement = [1, 0, 0]\nangle = 90\n", 20,
          "moved[0].displacement", {"left out beside angle"});
  refused(load, load + "[[moved]]\nregion = 'z+'\nangle = 90\naxis = 'z'\n", 18, "moved[0].centre",
          {"is missing"});
  refused(load, load + "[[moved]]\nregion = 'z+'\nangle = 0\naxis = 'z'\ncentre = [0, 0, 0]\n", 20,
          "moved[0].angle", {"other than 0"});
  refused("[[load]]\n" + load, "[[moved]]\nregion = 'z+'\ndisplacement = [0, 0, 0]\n", 1, "load",
          {"is missing", "[[moved]]"});
}

TEST_CASE("a motion that fades out over a zone is read, and the steps of its load") {
  const Case c = read_text(replaced(good_case, "[[load]]\nregion = 'z+'",
                                    "[[moved]]\nregion = 'x+ y+'\ndisplacement = [-1, 0, 0]\nsteps = 10\n"
                                    "scaled_displacement = { point = [1, 2, 3], normal = 'x', length = 5 }\n"
                                    "[[load]]\nregion = 'z+'"));
  REQUIRE(c.moved.size() == 1);
  CHECK(c.moved[0].steps == 10);
  CHECK(least_load_steps(c) == 10);
  REQUIRE(c.moved[0].scaled);
  CHECK(c.moved[0].scaled->point == Eigen::Vector3d(1, 2, 3));
  CHECK(c.moved[0].scaled->normal == Eigen::Vector3d(1, 0, 0));
  CHECK(c.moved[0].scaled->length == 5);
}

TEST_CASE("a mistake in a motion that fades out is refused where it is made") {
  const std::string from = "[[load]]\nregion = 'z+'",
                    moved = "[[moved]]\nregion = 'x+ y+'\ndisplacement = [-1, 0, 0]\n";
  const auto refused = mistakes_in(good_case);
  refused(from, moved + "scaled_displacement = { point = [1, 2, 3], normal = 'x', length = 1 }\n" + from, 17,
          "moved[0].scaled_displacement", {"must be more than the 1 mm by which"});
  refused(from, moved + "scaled_displacement = { point = [1, 2, 3], normal = 'x', length = 0 }\n" + from, 17,
          "moved[0].scaled_displacement.length", {"above 0 (mm)"});
  refused(from, moved + "scaled_displacement = { point = [1, 2, 3], normal = 'x', lenght = 2 }\n" + from, 17,
          "moved[0].scaled_displacement.lenght", {"length"});
  refused(from, moved + "steps = 0\n" + from, 17, "moved[0].steps", {"from 1 to 1000"});
}
