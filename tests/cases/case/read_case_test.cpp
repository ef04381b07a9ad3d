#include "cases/case/read_case.hpp"

#include "cases/scene/scene.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
using namespace case_text;
namespace fs = std::filesystem;

TEST_CASE("a complete case file is read to the last key") {
  const Case c = read_text(good_case);
  SECTION("name") {
    CHECK(c.name == "cube-shear-small");
    CHECK(c.description == "Shear of the cube.");
    CHECK(fs::path(c.file).filename() == "case.toml");
  }
  SECTION("body") {
    const Box& box = std::get<Box>(c.body);
    CHECK(box.size == Eigen::Vector3d(10, 10, 10));
    CHECK(box.cells == std::array<int, 3>{10, 10, 10});
  }
  SECTION("material") {
    const LinearElastic& material = std::get<LinearElastic>(c.material);
    CHECK(material.youngs_modulus == 0.3);
    CHECK(material.poissons_ratio == 0.35);
  }
  SECTION("supports") {
    REQUIRE(c.fixed.size() == 1);
    CHECK(c.fixed[0].region.name == "z-");
    CHECK(c.fixed[0].components == std::array<bool, 3>{true, true, true});
  }
  SECTION("loads") {
    REQUIRE(c.loads.size() == 1);
    CHECK(std::get<loads::NodalForce>(c.loads[0].kind).value == Eigen::Vector3d(0.002, 0, 0));
    CHECK(c.loads[0].region.where.line == 15);
    CHECK(c.loads[0].region.where.key == "load[0].region");
  }
  SECTION("finite elements") {
    CHECK(c.fem.formulation == Formulation::log_strain);
    CHECK(c.fem.element == Element::q1_bbar);
    CHECK(c.fem.refine == 1);
    CHECK(c.fem.where.line == 18);
  }
  SECTION("springs") {
    CHECK(c.msm.design == Design::moduli);
    CHECK(c.msm.poissons_ratio == 0.3);
    CHECK(c.msm.split == 0.8);
  }
  SECTION("measures") {
    REQUIRE(c.measures.size() == 1);
    CHECK(c.measures[0].name == "alpha_1");
    const auto& tilt = std::get<measures::Tilt>(c.measures[0].kind);
    CHECK(tilt.top.name == "z+ x- y-");
    CHECK(tilt.bottom.name == "z- x- y-");
    CHECK(tilt.toward == Axis::x);
    CHECK(tilt.up == Axis::z);
  }
  SECTION("expectations") {
    REQUIRE(c.expectations.size() == 1);
    CHECK(c.expectations[0].measure == "alpha_1");
    CHECK(c.expectations[0].quantity == Quantity::error_percent);
    CHECK(c.expectations[0].interval == std::array<double, 2>{-8, 0});
    CHECK(c.expectations[0].reference == ReferenceKind::published);
    CHECK(c.expectations[0].reason == "Table 4.5");
  }
}

TEST_CASE("every kind of load, measure and expectation is read") {
  const Case c = read_text(R"(
schema = 1
name = "everything"
body = { shape = "box", size = [4, 4, 16], cells = [4, 4, 16] }
material = { model = "ogden", mu = [0.01, 0.02], alpha = [2, -2.0], bulk_modulus = 40 }
symmetry = [{ plane = "x-" }, { plane = "y+" }]
[[fixed]]
near = [0, 0, 0]
components = ["x", "z"]
[[load]]
region = "x+ z+"
kind = "total_force"
value = [-0.05, 0, 0]
[[load]]
region = "z+"
kind = "traction"
value = [0, 0, 1e-3]
[[load]]
region = "z+"
kind = "torque"
value = 0.3
axis = [0, 0, -2]
centre = [2, 2, 16]
[[load]]
region = "near 4 4 16"
kind = "nodal_force"
value = [0, 1, 0]
[fem]
formulation = "hyperelastic"
element = "q2_p1"
[msm]
design = "given"
stiffness = [31, 47.5, 0]
volume_stiffness = 0.14
[[measure]]
name = "L"
kind = "coordinate"
node = "near 2 2 1.6e1"
axis = "z"
[[measure]]
name = "u"
kind = "displacement"
node = "x- y- z+"
component = "norm"
[[measure]]
name = "alpha"
kind = "tilt"
top = "x- y- z+"
bottom = "x- y- z-"
toward = "z"
up = "y"
[[measure]]
name = "beta"
kind = "twist"
node = "x- y- z+"
centre = "near 2 2 16"
axis = "y"
[[measure]]
name = "V"
kind = "volume"
[[measure]]
name = "l2"
kind = "displacement_field_l2"
[[measure]]
name = "max"
kind = "displacement_field_max"
[[expect]]
measure = "V"
msm = [255, 256]
reference = "exact"
reason = "a"
[[expect]]
measure = "u"
fem = [11.7, 11.7]
reference = "peer"
reason = "b"
)");
  SECTION("material") {
    const Ogden& ogden = std::get<Ogden>(c.material);
    CHECK(ogden.mu == std::vector<double>{0.01, 0.02});
    CHECK(ogden.alpha == std::vector<double>{2, -2});
    CHECK(ogden.bulk_modulus == 40.0);
  }
  SECTION("supports") {
    REQUIRE(c.symmetry.size() == 2);
    CHECK(c.symmetry[1].region.name == "y+");
    CHECK(c.symmetry[1].components == std::array<bool, 3>{false, true, false});
    CHECK(c.fixed[0].region.near == Eigen::Vector3d(0, 0, 0));
    CHECK(c.fixed[0].components == std::array<bool, 3>{true, false, true});
  }
  SECTION("loads") {
    REQUIRE(c.loads.size() == 4);
    CHECK(is<loads::TotalForce>(c.loads[0]));
    CHECK(is<loads::Traction>(c.loads[1]));
    const auto& torque = std::get<loads::Torque>(c.loads[2].kind);
    CHECK(torque.value == 0.3);
    CHECK(torque.axis == Eigen::Vector3d(0, 0, -1));
    CHECK(torque.centre == Eigen::Vector3d(2, 2, 16));
    CHECK(c.loads[3].region.near == Eigen::Vector3d(4, 4, 16));
  }
  SECTION("models") {
    CHECK(c.fem.element == Element::q2_p1);
    CHECK(c.msm.stiffness == std::array<double, 3>{31, 47.5, 0});
    CHECK(c.msm.volume_stiffness == 0.14);
  }
  SECTION("measures") {
    REQUIRE(c.measures.size() == 7);
    const auto& coordinate = std::get<measures::Coordinate>(c.measures[0].kind);
    CHECK(coordinate.node.near == Eigen::Vector3d(2, 2, 16));
    CHECK(coordinate.axis == Axis::z);
    CHECK(std::get<measures::Displacement>(c.measures[1].kind).component == Component::norm);
    const auto& tilt = std::get<measures::Tilt>(c.measures[2].kind);
    CHECK(tilt.up == Axis::y);
    CHECK(tilt.toward == Axis::z);
    const auto& twist = std::get<measures::Twist>(c.measures[3].kind);
    CHECK(twist.axis == Axis::y);
    CHECK(twist.centre.near == Eigen::Vector3d(2, 2, 16));
    CHECK(is<measures::DisplacementFieldMax>(c.measures[6]));
  }
  SECTION("expectations") {
    CHECK(c.expectations[0].quantity == Quantity::msm);
    CHECK(c.expectations[1].quantity == Quantity::fem);
    CHECK(c.expectations[1].reference == ReferenceKind::peer);
  }
}

TEST_CASE("what a case file leaves out follows from its material") {
  const auto cut = [](const std::string& text, const std::string& from, const std::string& to) {
    std::string shorter = text;
    return shorter.erase(text.find(from), text.find(to) - text.find(from));
  };
  const std::string bare = cut(cut(good_case, "[fem]", "[[measure]]"), "description", "[body]");
  const Case linear = read_text(bare);
  CHECK(linear.description.empty());
  CHECK(linear.fem.formulation == Formulation::log_strain);
  CHECK(linear.fem.element == Element::q1_bbar);
  CHECK(linear.fem.refine == 0);
  CHECK(linear.msm.design == Design::matched);
  const Case ogden =
      read_text(cut(bare, "[material]", "[[fixed]]") + "[material]\nmodel = 'ogden'\nmu=[0.04]\nalpha=[2]");
  CHECK(ogden.fem.formulation == Formulation::hyperelastic);
  CHECK(ogden.fem.element == Element::q1_p0);
  CHECK(ogden.msm.design == Design::matched);
}

TEST_CASE("a mistake outside of all tables is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  const std::string name = "name = 'cube-shear-small'";
  refused("schema = 1", "schema = 2", 1, "schema", {"is 2", "must be 1"});
  refused("schema = 1", "schema = '1'", 1, "schema", {"is \"1\"", "must be 1"});
  refused("schema = 1\n", "", 1, "schema", {"is missing"});
  refused("schema = 1\n", "schem = 1\n", 1, "schem", {"is not a key here", "did you mean \"schema\"?"});
  refused(name, "name = 'cube\nshear'", 2, "", {"is not valid TOML"});
  refused("[body]", "[body", 4, "", {"is not valid TOML"});
  refused("cells = [10, 10, 10]", "cells = [10, 10, 10]\nshape = 'box'", 8, "",
          {"is not valid TOML", "shape"});
  refused(name, "name = ''", 2, "name", {"not empty"});
  refused(name, "name = '  '", 2, "name", {"not empty"});
  refused(name, "name = '../cube'", 2, "name", {"is \"../cube\"", "has no /"});
  refused(name, "name = '<touch P;cat x'", 2, "name", {"begins with a letter"});
  refused(name, "name = '|touch P'", 2, "name", {"begins with a letter"});
  refused(name, "name = '-e'", 2, "name", {"begins with a letter"});
  refused(name, "name = '=1+1'", 2, "name", {"begins with a letter"});
  refused(name, "name = 'cube.'", 2, "name", {"nor a point"});
  refused(name, "name = 'a_Springs'", 2, "name", {"does not end with _springs", "case \"a\""});
  refused(name, "name = 'a_modes'", 2, "name", {"does not end with _modes"});
  refused(name, "name = 3", 2, "name", {"is 3", "a text"});
  refused("description = 'Shear of the cube.'", "descripton = 'Shear'", 3, "descripton",
          {"did you mean \"description\"?"});
  refused("description = 'Shear of the cube.'", "author = 'me'", 3, "author",
          {"is not a key here", "allowed are", "description"});
  refused("[body]\n", "", 1, "body", {"is missing", "[body]"}); // its keys fall to the top level
}

TEST_CASE("a file that cannot be read is named, with the reason") {
  CHECK_THROWS_WITH(read_case("/no/such/case.toml"),
                    Catch::StartsWith("/no/such/case.toml: cannot be read: No such file"));
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_case(folder.path.string()), Catch::Contains("cannot be read"));
}

TEST_CASE("every case file of the project is read, and its regions exist", "[long]") {
  int n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SPRINGPROOF_SOURCE_DIR) / "cases")) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().parent_path().filename() == "templates") continue; // no cases yet: see command_test.cpp
    INFO(entry.path().string());
    ++n;
    if (entry.path().parent_path().filename() != "hard") {
      Case read;
      CHECK_NOTHROW(read = read_case(entry.path().string()));
      const Labels* labels = std::get_if<Labels>(&read.body); // their package may not be installed
      if (labels == nullptr || fs::exists(labels->file.path)) CHECK_NOTHROW(make_scene(read));
      continue;
    }
    Case hard;
    CHECK_NOTHROW(hard = read_hard_case(entry.path().string()));
    CHECK(hard.name == entry.path().stem().string()); // they are asked for by it
    CHECK(hard.description.size() > 40);              // a sentence
    const bool is_refused = hard.stress->expected.at(0).outcome == Outcome::refused;
    if (is_refused) CHECK_THROWS_AS(make_scene(hard), InputError);
    if (!hard.stress->is_heavy && !is_refused) CHECK_NOTHROW(make_scene(hard));
  }
  CHECK(n >= 12); // the thesis's cube alone: two materials, three tests, two load sets
}

TEST_CASE("a key of very many dotted parts is refused with its line, however it is written") {
  std::string key = "a";
  for (int part = 0; part < 50'000; ++part) key += ".a";
  for (const std::string& line : {key + " = 1", "[" + key + "]", "x = {" + key + " = 1}"})
    CHECK_THROWS_WITH(read_case_text("schema = 1\n" + line + "\n", "a.toml"),
                      Catch::StartsWith("a.toml:2:1: has more than 100 points"));
  std::string nested; // nested as deep as allowed: inline tables in arrays, which may have several lines
  const std::string part = key.substr(0, 199);
  for (int level = 0; level < 100; ++level) nested += (level == 0 ? "x" : "{" + part) + " = [\n";
  CHECK_THROWS_AS(read_case_text(nested, "a.toml"), InputError);
  for (int level = 0; level < 100; ++level) nested += level < 99 ? "]}\n" : "]\n";
  CHECK_THROWS_AS(read_case_text(nested, "a.toml"), InputError);
}
