#include "cases/scene/network.hpp"

#include "cases/case/read_case.hpp"
#include "cases/scene/loads.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace springproof;

using namespace cases;

TEST_CASE("a network's lines are node, node, stiffness, and perhaps rest length and exponent") {
  const auto springs =
      read_network("# my lattice\na,b,stiffness\n0,1,31\n\n1, 2, 47.5, 1.25\n2,0,1e3,,-1.5\r\n", "n.csv", 3);
  REQUIRE(springs.size() == 3);
  CHECK(springs[0].a == 0);
  CHECK(springs[0].b == 1);
  CHECK(springs[0].stiffness == Approx(0.031).epsilon(1e-15)); // N/m become N/mm
  CHECK_FALSE(springs[0].rest_length);
  CHECK_FALSE(springs[0].exponent);
  CHECK(springs[1].rest_length == 1.25);
  CHECK_FALSE(springs[2].rest_length);
  CHECK(springs[2].exponent == -1.5);
  CHECK(springs[2].stiffness == Approx(1).epsilon(1e-15));
}

TEST_CASE("nodes of a network are x, y, z, and perhaps mass") {
  const NetworkNodes nodes = read_nodes("x,y,z\n0,1,-2.5\n# a comment\n1e1, 0, 0\r\n", "n.csv");
  REQUIRE(nodes.places.size() == 2);
  CHECK(nodes.places[0] == Eigen::Vector3d(0, 1, -2.5));
  CHECK(nodes.places[1] == Eigen::Vector3d(10, 0, 0));
  CHECK(nodes.masses.empty());
  const NetworkNodes heavy = read_nodes("0,0,0,2\n1,0,0,0.5\n", "n.csv");
  REQUIRE(heavy.masses.size() == 2);
  CHECK(heavy.masses[0] == Approx(2e-3).epsilon(1e-15)); // kg become t
  CHECK(heavy.masses[1] == Approx(5e-4).epsilon(1e-15));
}

TEST_CASE("a mistake in a network's nodes is refused with its line and field") {
  const auto refused = [](const std::string& line, const std::string& with, const char* first = "0,0,0\n") {
    CAPTURE(line);
    CHECK_THROWS_WITH(read_nodes(first + line, "n.csv"),
                      Catch::Contains("n.csv:2: ") && Catch::Contains(with));
  };
  refused("1,2\n", "2 fields; a node has x, y, z (mm), and perhaps mass (kg)");
  refused("1,2,3,4,5\n", "5 fields");
  refused("1,,3\n", "y is missing");
  refused("1,2,nan\n", "z is nan, must be a number from -1e9 to 1e9 (mm)");
  refused("1e10,2,3\n", "x is 1e10");
  refused("1,2,3,1\n", "mass is 1, must be left out as before");
  refused("1,2,3\n", "mass is missing, must be there as before (kg)", "0,0,0,1\n");
  refused("1,2,3,0\n", "mass is 0, must be a number from 1e-12", "0,0,0,1\n");
  CHECK_THROWS_WITH(read_nodes("# nothing\n", "n.csv"), Catch::Contains("at least one node"));
}

namespace {

/// A network of two springs in a row, without loads.
const std::string row_case = R"(schema = 1
name = "row"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[[fixed]]
region = "x-"
)";
const std::string pull = "[[load]]\nregion = \"x+\"\nkind = \"nodal_force\"\nvalue = [1, 0, 0]\n";

struct RowFolder : TemporaryFolder {
  RowFolder() {
    write("nodes.csv", "0,0,0\n1,0,0\n2,0,0\n");
    write("springs.csv", "0,1,1\n1,2,1\n");
  }
  Scene scene(const std::string& more) const {
    return make_scene(read_case_text(row_case + more, (path / "case.toml").string()));
  }
};

} // namespace

TEST_CASE("a network without cells has its nodes, springs and regions of nodes") {
  const RowFolder folder;
  const Scene scene = folder.scene(pull);
  CHECK(scene.mesh.nodes.size() == 3);
  CHECK(scene.mesh.cells.empty());
  CHECK(scene.network.size() == 2);
  CHECK(scene.mesh.lines == std::vector<std::array<int, 2>>{{0, 1}, {1, 2}});
  REQUIRE(scene.loads.size() == 1);
  CHECK(scene.loads[0].selection.nodes == std::vector<int>{2});
  CHECK(scene.definition.msm.design == Design::network);
  CHECK_FALSE(has_finite_elements(scene.definition));
}

TEST_CASE("what needs cells, faces or masses is refused for a network, with what to do instead") {
  const RowFolder folder;
  const auto refused = [&](const std::string& more, const std::string& with) {
    CAPTURE(more);
    CHECK_THROWS_WITH(folder.scene(more), Catch::Contains(with));
  };
  const auto measure = [](const std::string& keys) { return "[[measure]]\nname = \"m\"\nkind = " + keys; };
  refused("[[load]]\nregion = \"x+\"\nkind = \"traction\"\nvalue = [1, 0, 0]\n",
          "acts on faces, and a network has none; must be one of a nodal_force or a total_force");
  refused("[[load]]\nnear = [2, 0, 0]\nradius = 1\nkind = \"nodal_force\"\nvalue = [1, 0, 0]\n",
          "is a patch of faces, and a network has none; must be nodes");
  refused("[[load]]\nkind = \"gravity\"\nvalue = [0, 0, -9.81]\n",
          "has no masses, which gravity needs: give every node a fourth column, kg");
  refused(pull + "[[mass]]\nregion = \"x+\"\nvalue = 1\n", "which [[mass]] needs");
  refused(pull + "[dynamics]\nscheme = \"bdf2\"\nstep = 0.1\nend = 1\n", "which [dynamics] needs");
  refused(pull + "[msm]\nreal_time = { method = \"xpbd\" }\n", "which msm.real_time needs");
  for (const char* kind : {"volume", "displacement_field_l2"})
    refused(pull + measure("\"" + std::string(kind) + "\"\n"),
            "which is one of cells, and a network has none");
  for (const char* kind : {"stress", "strain"})
    refused(pull + measure("\"" + std::string(kind) + "\"\ncomponent = \"xx\"\nstatistic = \"mean\"\n"),
            "which is one of cells");
  refused(pull + measure("\"displacement\"\nat = [1, 0, 0]\ncomponent = \"x\"\n"), "is a point of a cell");
  refused(pull + "[material]\nmodel = \"linear_elastic\"\n", "springs of a network have no material");
  refused(pull + "[fem]\nrefine = 1\n", "must be left out, or have a table [fem.body]");
  refused(pull + "[msm]\ndesign = \"hybrid\"\n", "the springs are those of body.springs");
  refused(pull + "[msm]\nmass = \"uniform\"\n", "body.nodes the masses");
  refused(pull + "[surface]\nfile = \"a.stl\"\n", "a network has no cells for it");
  refused(pull + "[[region_material]]\n", "a network has no cells for it");
  refused(pull + "[[body.removed]]\nbox = [[0, 0, 0], [1, 1, 1]]\n", "pieces are removed from cells");
}

namespace {

/// The same network beside a tetrahedron of 4/3 mm³.
struct TetrahedronFolder : RowFolder {
  TetrahedronFolder() {
    write("one.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                     "$Nodes\n4\n1 0 0 0\n2 2 0 0\n3 0 2 0\n4 0 0 2\n$EndNodes\n"
                     "$Elements\n1\n1 4 2 0 1 1 2 3 4\n$EndElements\n");
  }
  /// @param more  tables, then keys of [fem]
  Scene scene(const std::string& more) const {
    return RowFolder::scene(pull +
                            "[material]\nmodel = \"linear_elastic\"\nyoungs_modulus = 0.1\n"
                            "poissons_ratio = 0.3\ndensity = 3e5\n" +
                            more + "[fem.body]\nshape = \"mesh\"\nfile = \"one.msh\"\n");
  }
};

} // namespace

TEST_CASE("finite elements beside a network have the elements of their own body's shape") {
  const TetrahedronFolder folder;
  const auto scene = [&](const std::string& element) { return folder.scene("[fem]\n" + element); };
  CHECK(scene("").definition.fem.element == Element::p2);
  CHECK(scene("element = \"p1\"\n").definition.fem.element == Element::p1);
  CHECK_THROWS_WITH(scene("element = \"q1\"\n"),
                    Catch::Contains("a mesh of tetrahedra") && Catch::Contains("[fem.body]"));
}

TEST_CASE("a network shares the mass of the finite elements' body, without masses that are added to both") {
  const TetrahedronFolder folder;
  const std::string heavy = "[[mass]]\nregion = \"x+\"\nvalue = 0.001\n",
                    gravity = "[[load]]\nkind = \"gravity\"\nvalue = [0, 0, -9.81]\n";
  const Scene equal = folder.scene(heavy + gravity);
  REQUIRE(equal.node_masses.size() == 3);
  for (const double mass : equal.node_masses) CHECK(mass == Approx(4. / 9 * 1e-9 * 3e5 * 1e-3)); // t
  const std::vector<double> all = point_masses(equal);
  CHECK(all[2] - all[1] == Approx(1e-6));
  CHECK(equal.remarks.empty());
  folder.write("nodes.csv", "0,0,0,1\n1,0,0,1\n2,0,0,1\n");
  CHECK(folder.scene("").remarks.empty());
  const Scene other = folder.scene(gravity);
  REQUIRE(other.remarks.size() == 1);
  CHECK_THAT(other.remarks[0], Catch::Contains("nodes of 3 kg, where [fem.body] has 0.0004 kg"));
}

TEST_CASE("a mistake in a network is refused with its line and field") {
  const auto refused = [](const std::string& text, const std::string& with) {
    CAPTURE(text);
    CHECK_THROWS_WITH(read_network("0,1,1\n" + text, "n.csv", 8),
                      Catch::Contains("n.csv:2: ") && Catch::Contains(with));
  };
  refused("0,1\n", "2 fields");
  refused("0,1,2,3,4,5\n", "6 fields");
  refused("0,8,1\n", "node b is 8, must be the number of a node, from 0 to 7");
  refused("-1,2,1\n", "node a is -1");
  refused("0.5,2,1\n", "node a is 0.5");
  refused("3,3,1\n", "another node");
  refused("0,1,,1\n", "stiffness is missing");
  refused("0,1,0\n", "stiffness is 0");
  refused("0,1,nan\n", "stiffness is nan");
  refused("0,1,1e999\n", "stiffness is 1e999");
  refused("0,1,1x\n", "stiffness is 1x");
  refused("4294967296,1,1\n", "node a is 4294967296");
  refused("99999999999999999999,1,1\n", "node a is 99999999999999999999");
  refused("0,1,1,1e400\n", "rest length is 1e400");
  refused("0,1,1,,1e400\n", "exponent is 1e400");
  refused("0,1,1,,-1e-400\n", "exponent is -1e-400");
  refused("x2,3,1\n", "node a is x2");
  refused("node_a,node_b,stiffness\n", "node a is node_a");
  CHECK_THROWS_WITH(read_network("x0,1,1\n", "n.csv", 8), Catch::Contains("n.csv:1: node a is x0"));
  refused("0,1,1,-2\n", "rest length is -2");
  refused("0,1,1,,21\n", "exponent is 21");
  CHECK_THROWS_WITH(read_network("# nothing\n", "n.csv", 8), Catch::Contains("at least one spring"));
}

TEST_CASE("springs that join the same nodes, and rest lengths far from the distance, are counted") {
  const auto on_a_line = [](int n) { return Eigen::Vector3d(n, 0, 0); };
  const auto doubts = [&](const std::string& text) {
    return cases::doubts_of(read_network(text, "n.csv", 8), on_a_line);
  };
  CHECK(doubts("0,1,1\n1,2,1,1.09\n").empty());
  const auto twice = doubts("0,1,1\n1,0,2\n3,2,1\n2,3,1\n2,3,1\n");
  REQUIRE(twice.size() == 1);
  CHECK_THAT(twice[0], Catch::StartsWith(
                           "3 of 5 springs join two nodes that another one joins already, nodes 0 and 1"));
  const auto far = doubts("0,1,1,1.2\n1,3,1,0.5\n4,5,1\n");
  REQUIRE(far.size() == 1);
  CHECK_THAT(far[0], Catch::StartsWith("2 of 3 springs have a rest length more than 10 %") &&
                         Catch::Contains("nodes 1 and 3 0.5 mm for 2 mm"));
}

TEST_CASE("nodes without springs, and pieces that hang on nothing, are named") {
  Case definition;
  definition.body = Box{{3, 1, 1}, {3, 1, 1}}; // nodes 0 to 15, those of x = 0 are 0, 4, 8 and 12
  definition.fixed.push_back({{"x-"}, {true, true, true}});
  Scene scene = make_scene(definition);
  const auto parts = [&](const std::string& springs) {
    scene.network = read_network(springs, "n.csv", 16);
    return loose_parts_of(scene);
  };
  std::string all;
  for (int n = 1; n < 16; ++n) all += fmt::format("{},{},1\n", n - 1, n);
  CHECK(parts(all).empty());
  const auto some = parts("0,1,1\n2,3,1\n6,7,1\n7,3,1\n10,11,1\n");
  REQUIRE(some.size() == 3);
  CHECK(some[0] == "5 of 16 nodes have no spring and no support: 5, 9, 13, 14, 15");
  CHECK(some[1] ==
        "a piece of 4 nodes and its springs hangs on nothing: no support acts on nodes 2, 3, 6, 7");
  CHECK(some[2] == "a piece of 2 nodes and its springs hangs on nothing: no support acts on nodes 10, 11");
}
