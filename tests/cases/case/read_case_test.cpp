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
    CHECK(c.loads[0].kind == LoadKind::nodal_force);
    CHECK(c.loads[0].value == Eigen::Vector3d(0.002, 0, 0));
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
    CHECK(c.measures[0].kind == MeasureKind::tilt);
    CHECK(c.measures[0].top.name == "z+ x- y-");
    CHECK(c.measures[0].bottom.name == "z- x- y-");
    CHECK(c.measures[0].toward == Axis::x);
    CHECK(c.measures[0].axis == Axis::z);
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
    CHECK(c.loads[0].kind == LoadKind::total_force);
    CHECK(c.loads[1].kind == LoadKind::traction);
    CHECK(c.loads[2].kind == LoadKind::torque);
    CHECK(c.loads[2].moment == 0.3);
    CHECK(c.loads[2].axis == Eigen::Vector3d(0, 0, -1));
    CHECK(c.loads[2].centre == Eigen::Vector3d(2, 2, 16));
    CHECK(c.loads[3].region.near == Eigen::Vector3d(4, 4, 16));
  }
  SECTION("models") {
    CHECK(c.fem.element == Element::q2_p1);
    CHECK(c.msm.stiffness == std::array<double, 3>{31, 47.5, 0});
    CHECK(c.msm.volume_stiffness == 0.14);
  }
  SECTION("measures") {
    REQUIRE(c.measures.size() == 7);
    CHECK(c.measures[0].node.near == Eigen::Vector3d(2, 2, 16));
    CHECK(c.measures[0].axis == Axis::z);
    CHECK(c.measures[1].component == Component::norm);
    CHECK(c.measures[2].axis == Axis::y);
    CHECK(c.measures[2].toward == Axis::z);
    CHECK(c.measures[3].axis == Axis::y);
    CHECK(c.measures[3].centre.near == Eigen::Vector3d(2, 2, 16));
    CHECK(c.measures[6].kind == MeasureKind::displacement_field_max);
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

TEST_CASE("a body of a mesh file takes the names of groups as regions, and finds the file beside the case") {
  const TemporaryFolder folder;
  folder.write("bar.geo", "");
  std::string text = replaced(good_case, "shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n",
                              "shape = 'mesh'\nfile = 'bar.geo'\n");
  text = replaced(text, "region = 'z-'", "region = 'clamped end'");
  const Case c = read_case(folder.write("case.toml", text));
  CHECK(std::get<MeshFile>(c.body).path == (folder.path / "bar.geo").string());
  CHECK(std::get<MeshFile>(c.body).where.line == 6);
  CHECK(c.fixed[0].region.name == "clamped end");
}

TEST_CASE("a body of voxels is read, and finds its surface beside the case") {
  const TemporaryFolder folder;
  folder.write("body.stl", "");
  const Case c = read_case(folder.write(
      "case.toml", replaced(good_case, "shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n",
                            "shape = 'voxels'\nsurface = 'body.stl'\nedge = 0.5\n")));
  CHECK(std::get<Voxels>(c.body).edge == 0.5);
  CHECK(std::get<Voxels>(c.body).path == (folder.path / "body.stl").string());
}

namespace {

const std::string labelled =
    "shape = 'labels'\nfile = 'case.toml.nii'\nedge = 1.5\ncrop = [[0, 0, 0], [9, 8, 7]]\n"
    "keep = 'largest'\n[[body.classes]]\nname = 'bone'\nlower = 226\nupper = 3000\n"
    "rigid = true\n[[body.classes]]\nname = 'skin'\nlower = -200\nupper = 225\n";

std::string labelled_case() {
  return replaced(good_case, "shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n", labelled);
}

} // namespace

TEST_CASE("a labelled volume is read with its classes which are regions and have materials") {
  const TemporaryFolder folder;
  folder.write("case.toml.nii", "");
  std::string text = replaced(labelled_case(), "[[fixed]]\nregion = 'z-'\n", "");
  text = replaced(text, "region = 'z+'\nkind = 'nodal_force'",
                  "region = { class = 'skin' }\nkind = 'nodal_force'");
  text += "\n[[region_material]]\nclass = 'skin'\nmodel = 'linear_elastic'\nyoungs_modulus = 0.05\n"
          "poissons_ratio = 0.35\n";
  const Case c = read_case(folder.write("case.toml", text));
  const Labels& labels = std::get<Labels>(c.body);
  CHECK(labels.edge == 1.5);
  CHECK(labels.keep == Keep::largest);
  CHECK(labels.crop->at(1) == Eigen::Vector3d(9, 8, 7));
  REQUIRE(labels.classes.size() == 2);
  CHECK(labels.classes[0].name == "bone");
  CHECK(labels.classes[0].is_rigid);
  CHECK(labels.classes[1].lower == -200);
  CHECK(c.fixed.empty()); // bone holds the body
  CHECK(c.loads[0].region.part->cell_class == "skin");
  CHECK(c.region_materials[0].group == "skin");
  text = replaced(text, "keep = 'largest'", "keep = [1, 2, 3]");
  const Case seeded = read_case(folder.write("case.toml", text));
  CHECK(std::get<Labels>(seeded.body).keep == Keep::seed);
  CHECK(std::get<Labels>(seeded.body).seed == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("a mistake in a labelled volume is refused where it is made") {
  const auto refused = [](const std::string& what, const std::string& by) {
    const TemporaryFolder folder;
    folder.write("case.toml.nii", "");
    try {
      read_case(folder.write("case.toml", replaced(labelled_case(), what, by)));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  CHECK_THAT(refused("edge = 1.5", "edge = 0"), Catch::Contains("body.edge: is 0"));
  CHECK_THAT(refused("'case.toml.nii'", "'case.toml.dcm'"), Catch::Contains(".nrrd"));
  CHECK_THAT(refused("[9, 8, 7]", "[9, 0, 7]"), Catch::Contains("the lower first"));
  CHECK_THAT(refused("keep = 'largest'", "keep = 'all'"), Catch::Contains("\"largest\" or a point"));
  CHECK_THAT(refused("name = 'skin'", "name = 'bone'"), Catch::Contains("another name"));
  CHECK_THAT(refused("name = 'skin'", "name = 'x- z+'"), Catch::Contains("not one of a face"));
  CHECK_THAT(refused("upper = 225", "upper = -225"), Catch::Contains("at least lower"));
  CHECK_THAT(refused("upper = 225", "upper = 225\nrigid = true"), Catch::Contains("in one class at most"));
  CHECK_THAT(refused("lower = 226\n", ""), Catch::Contains("body.classes[0].lower: is missing"));
  CHECK_THAT(refused("region = 'z-'", "region = { class = 'bon' }"),
             Catch::Contains("did you mean \"bone\"?"));
  CHECK_THAT(refused(labelled, "shape = 'labels'\nfile = 'case.toml.nii'\nedge = 1\n"),
             Catch::Contains("[[body.classes]]"));
}

TEST_CASE("a mistake outside of all tables is refused where it is made") {
  check_mistakes({
      {"schema = 1", "schema = 2", 1, "schema", {"is 2", "must be 1"}},
      {"schema = 1", "schema = '1'", 1, "schema", {"is \"1\"", "must be 1"}},
      {"schema = 1\n", "", 1, "schema", {"is missing"}},
      {"schema = 1\n", "schem = 1\n", 1, "schem", {"is not a key here", "did you mean \"schema\"?"}},
      {"name = 'cube-shear-small'", "name = 'cube\nshear'", 2, "", {"is not valid TOML"}},
      {"[body]", "[body", 4, "", {"is not valid TOML"}},
      {"cells = [10, 10, 10]", "cells = [10, 10, 10]\nshape = 'box'", 8, "", {"is not valid TOML", "shape"}},
      {"name = 'cube-shear-small'", "name = ''", 2, "name", {"not empty"}},
      {"name = 'cube-shear-small'", "name = '  '", 2, "name", {"not empty"}},
      {"name = 'cube-shear-small'", "name = '../cube'", 2, "name", {"is \"../cube\"", "has no /"}},
      {"name = 'cube-shear-small'", "name = '<touch P;cat x'", 2, "name", {"begins with a letter"}},
      {"name = 'cube-shear-small'", "name = '|touch P'", 2, "name", {"begins with a letter"}},
      {"name = 'cube-shear-small'", "name = '-e'", 2, "name", {"begins with a letter"}},
      {"name = 'cube-shear-small'", "name = '=1+1'", 2, "name", {"begins with a letter"}},
      {"name = 'cube-shear-small'", "name = 'cube.'", 2, "name", {"nor a point"}},
      {"name = 'cube-shear-small'",
       "name = 'a_Springs'",
       2,
       "name",
       {"does not end with _springs", "case \"a\""}},
      {"name = 'cube-shear-small'", "name = 'a_modes'", 2, "name", {"does not end with _modes"}},
      {"name = 'cube-shear-small'", "name = 3", 2, "name", {"is 3", "a text"}},
      {"description = 'Shear of the cube.'",
       "descripton = 'Shear'",
       3,
       "descripton",
       {"did you mean \"description\"?"}},
      {"description = 'Shear of the cube.'",
       "author = 'me'",
       3,
       "author",
       {"is not a key here", "allowed are", "description"}},
      {"[body]\n", "", 1, "body", {"is missing", "[body]"}}, // its keys fall to the top level
  });
}

TEST_CASE("a mistake in [body] is refused where it is made") {
  check_mistakes({
      {"[body]", "[boddy]", 4, "boddy", {"did you mean \"body\"?"}},
      {"shape = 'box'",
       "shape = 'bax'",
       5,
       "body.shape",
       {"is \"bax\"", "\"box\" | \"mesh\"", "did you mean \"box\"?"}},
      {"shape = 'box'\n", "", 4, "body.shape", {"is missing", "\"box\" | \"mesh\""}},
      {"size = [10.0, 10.0, 10]", "sise = [10.0, 10.0, 10]", 6, "body.sise", {"did you mean \"size\"?"}},
      {"size = [10.0, 10.0, 10]",
       "size = [10.0, 10.0]",
       6,
       "body.size",
       {"is [10.0, 10.0]", "three numbers above 0 (mm)"}},
      {"size = [10.0, 10.0, 10]", "size = [10.0, -1, 10]", 6, "body.size", {"-1", "above 0"}},
      {"size = [10.0, 10.0, 10]", "size = [10.0, nan, 10]", 6, "body.size", {"nan", "above 0"}},
      {"size = [10.0, 10.0, 10]", "size = 10", 6, "body.size", {"is 10", "three numbers"}},
      {"cells = [10, 10, 10]",
       "cells = [10, 10.5, 10]",
       7,
       "body.cells",
       {"10.5", "three whole numbers above 0"}},
      {"cells = [10, 10, 10]", "cells = [10, 0, 10]", 7, "body.cells", {"above 0"}},
      {"cells = [10, 10, 10]", "cells = [100000, 100000, 10]", 7, "body.cells", {"fewer"}},
      {"shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = 'mesh'\nfile = 'no.msh'",
       6,
       "body.file",
       {"is \"no.msh\"", "there is no"}},
      {"shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = 'mesh'\nfile = 'bar.stl'",
       6,
       "body.file",
       {".msh or .geo"}},
      {"shape = 'box'", "shape = 'box'\nfile = 'a.msh'", 6, "body.file", {"is not a key here"}},
      {"shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = 'voxels'\nsurface = 'no.stl'\nedge = 1",
       6,
       "body.surface",
       {"is \"no.stl\"", "there is no"}},
      {"shape = 'box'\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = 'voxels'\nsurface = 'no.obj'\nedge = 1",
       6,
       "body.surface",
       {"a closed surface in STL"}},
  });
}

TEST_CASE("a file that cannot be read is named, with the reason") {
  CHECK_THROWS_WITH(read_case("/no/such/case.toml"),
                    Catch::StartsWith("/no/such/case.toml: cannot be read: No such file"));
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_case(folder.path.string()), Catch::Contains("cannot be read"));
}

TEST_CASE("every case file of the project is read, and its regions exist") {
  int n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SPRINGPROOF_SOURCE_DIR) / "cases")) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().parent_path().filename() == "templates") continue; // no cases yet: see command_test.cpp
    INFO(entry.path().string());
    ++n;
    if (entry.path().parent_path().filename() != "hard") {
      Case read;
      CHECK_NOTHROW(read = read_case(entry.path().string()));
      const Labels* labels = std::get_if<Labels>(&read.body); // of a package that may not be installed
      if (labels == nullptr || fs::exists(labels->path)) CHECK_NOTHROW(make_scene(read));
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
  std::string nested; // as deep as is allowed: inline tables in arrays, which may have several lines
  const std::string part = key.substr(0, 199);
  for (int level = 0; level < 100; ++level) nested += (level == 0 ? "x" : "{" + part) + " = [\n";
  CHECK_THROWS_AS(read_case_text(nested, "a.toml"), InputError);
  for (int level = 0; level < 100; ++level) nested += level < 99 ? "]}\n" : "]\n";
  CHECK_THROWS_AS(read_case_text(nested, "a.toml"), InputError);
}

TEST_CASE("pieces that are removed from a body are read") {
  const Case c = read_text(replaced(good_case, "cells = [10, 10, 10]",
                                    "cells = [10, 10, 10]\n[[body.removed]]\nbox = [[1, 2, 3], [4, 5, 6]]\n"
                                    "[[body.removed]]\nbox = [[7, 2, 3], [8, 5, 6]]\njoin = 'y'"));
  REQUIRE(c.removed.size() == 2);
  CHECK(c.removed[0].lower == Eigen::Vector3d(1, 2, 3));
  CHECK(c.removed[0].upper == Eigen::Vector3d(4, 5, 6));
  CHECK_FALSE(c.removed[0].join);
  CHECK(c.removed[1].join == Axis::y);
  const std::string from = "cells = [10, 10, 10]";
  check_mistakes({
      {from,
       from + "\n[[body.removed]]\nbox = [[1, 2, 3], [1, 5, 6]]",
       9,
       "body.removed[0].box",
       {"lower first"}},
      {from,
       from + "\n[[body.removed]]\nbox = [[1, 2, 3], [2, 5, 6]]\njoin = 'w'",
       10,
       "body.removed[0].join",
       {"\"x\""}},
  });
}
