#include "cases/scene/network.hpp"

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
