#include "cases/case/read_case.hpp"

#include "cases/case/hard_case.hpp"
#include "cases/case/names.hpp"
#include "cases/scene/scene.hpp"
#include "tests/cases/case/case_text.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using namespace cases;
namespace fs = std::filesystem;
using case_text::Mistake;
using case_text::replaced;

namespace {

// Line numbers matter below: `schema` is on line 1.
const std::string good_case = R"(schema = 1
name = "cube-shear-small"
description = "Shear of the cube."
[body]
shape = "box"
size = [10.0, 10.0, 10]
cells = [10, 10, 10]
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.35
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "nodal_force"
value = [0.002, 0, 0.0]
[fem]
formulation = "log_strain"
element = "q1_bbar"
refine = 1
[msm]
design = "moduli"
poissons_ratio = 0.3
split = 0.8
[[measure]]
name = "alpha_1"
kind = "tilt"
top = "z+ x- y-"
bottom = "z- x- y-"
toward = "x"
[[expect]]
measure = "alpha_1"
error_percent = [-8.0, 0.0]
reference = "published"
reason = "Table 4.5"
)";

void check_refused(const std::string& text, const Mistake& mistake) {
  case_text::check_refused(text, mistake, [](const std::string& path) { read_case(path); });
}

Case read_text_as_case(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return read_case(folder.write("case.toml", text), overrides);
}

} // namespace

TEST_CASE("a complete case file is read to the last key") {
  const Case c = read_text_as_case(good_case);
  CHECK(c.name == "cube-shear-small");
  CHECK(c.description == "Shear of the cube.");
  CHECK(fs::path(c.file).filename() == "case.toml");
  const Box& box = std::get<Box>(c.body);
  CHECK(box.size == Eigen::Vector3d(10, 10, 10));
  CHECK(box.cells == std::array<int, 3>{10, 10, 10});
  const LinearElastic& material = std::get<LinearElastic>(c.material);
  CHECK(material.youngs_modulus == 0.3);
  CHECK(material.poissons_ratio == 0.35);
  REQUIRE(c.fixed.size() == 1);
  CHECK(c.fixed[0].region.name == "z-");
  CHECK(c.fixed[0].components == std::array<bool, 3>{true, true, true});
  REQUIRE(c.loads.size() == 1);
  CHECK(c.loads[0].kind == LoadKind::nodal_force);
  CHECK(c.loads[0].value == Eigen::Vector3d(0.002, 0, 0));
  CHECK(c.loads[0].region.where.line == 15);
  CHECK(c.loads[0].region.where.key == "load[0].region");
  CHECK(c.fem.formulation == Formulation::log_strain);
  CHECK(c.fem.element == Element::q1_bbar);
  CHECK(c.fem.refine == 1);
  CHECK(c.fem.where.line == 18);
  CHECK(c.msm.design == Design::moduli);
  CHECK(c.msm.poissons_ratio == 0.3);
  CHECK(c.msm.split == 0.8);
  REQUIRE(c.measures.size() == 1);
  CHECK(c.measures[0].name == "alpha_1");
  CHECK(c.measures[0].kind == MeasureKind::tilt);
  CHECK(c.measures[0].top.name == "z+ x- y-");
  CHECK(c.measures[0].bottom.name == "z- x- y-");
  CHECK(c.measures[0].toward == Axis::x);
  CHECK(c.measures[0].axis == Axis::z);
  REQUIRE(c.expectations.size() == 1);
  CHECK(c.expectations[0].measure == "alpha_1");
  CHECK(c.expectations[0].quantity == Quantity::error_percent);
  CHECK(c.expectations[0].interval == std::array<double, 2>{-8, 0});
  CHECK(c.expectations[0].reference == ReferenceKind::published);
  CHECK(c.expectations[0].reason == "Table 4.5");
}

TEST_CASE("every kind of load, measure and expectation is read") {
  const Case c = read_text_as_case(R"(
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
  const Ogden& ogden = std::get<Ogden>(c.material);
  CHECK(ogden.mu == std::vector<double>{0.01, 0.02});
  CHECK(ogden.alpha == std::vector<double>{2, -2});
  CHECK(ogden.bulk_modulus == 40.0);
  REQUIRE(c.symmetry.size() == 2);
  CHECK(c.symmetry[1].region.name == "y+");
  CHECK(c.symmetry[1].components == std::array<bool, 3>{false, true, false});
  CHECK(c.fixed[0].region.near == Eigen::Vector3d(0, 0, 0));
  CHECK(c.fixed[0].components == std::array<bool, 3>{true, false, true});
  REQUIRE(c.loads.size() == 4);
  CHECK(c.loads[0].kind == LoadKind::total_force);
  CHECK(c.loads[1].kind == LoadKind::traction);
  CHECK(c.loads[2].kind == LoadKind::torque);
  CHECK(c.loads[2].moment == 0.3);
  CHECK(c.loads[2].axis == Eigen::Vector3d(0, 0, -1));
  CHECK(c.loads[2].centre == Eigen::Vector3d(2, 2, 16));
  CHECK(c.loads[3].region.near == Eigen::Vector3d(4, 4, 16));
  CHECK(c.fem.element == Element::q2_p1);
  CHECK(c.msm.stiffness == std::array<double, 3>{31, 47.5, 0});
  CHECK(c.msm.volume_stiffness == 0.14);
  REQUIRE(c.measures.size() == 7);
  CHECK(c.measures[0].node.near == Eigen::Vector3d(2, 2, 16));
  CHECK(c.measures[0].axis == Axis::z);
  CHECK(c.measures[1].component == Component::norm);
  CHECK(c.measures[2].axis == Axis::y);
  CHECK(c.measures[2].toward == Axis::z);
  CHECK(c.measures[3].axis == Axis::y);
  CHECK(c.measures[3].centre.near == Eigen::Vector3d(2, 2, 16));
  CHECK(c.measures[6].kind == MeasureKind::displacement_field_max);
  CHECK(c.expectations[0].quantity == Quantity::msm);
  CHECK(c.expectations[1].quantity == Quantity::fem);
  CHECK(c.expectations[1].reference == ReferenceKind::peer);
}

TEST_CASE("what a case file leaves out follows from its material") {
  const auto cut = [](const std::string& text, const std::string& from, const std::string& to) {
    std::string shorter = text;
    return shorter.erase(text.find(from), text.find(to) - text.find(from));
  };
  const std::string bare = cut(cut(good_case, "[fem]", "[[measure]]"), "description", "[body]");
  const Case linear = read_text_as_case(bare);
  CHECK(linear.description.empty());
  CHECK(linear.fem.formulation == Formulation::log_strain);
  CHECK(linear.fem.element == Element::q1_bbar);
  CHECK(linear.fem.refine == 0);
  CHECK(linear.msm.design == Design::linear_method);
  const Case ogden = read_text_as_case(cut(bare, "[material]", "[[fixed]]") +
                                       "[material]\nmodel = \"ogden\"\nmu=[0.04]\nalpha=[2]");
  CHECK(ogden.fem.formulation == Formulation::hyperelastic);
  CHECK(ogden.fem.element == Element::q1_p0);
  CHECK(ogden.msm.design == Design::nonlinear_method);
}

TEST_CASE("a body of a mesh file takes the names of groups as regions, and finds the file beside the case") {
  const TemporaryFolder folder;
  folder.write("bar.geo", "");
  std::string text = replaced(good_case, "shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n",
                              "shape = \"mesh\"\nfile = \"bar.geo\"\n");
  text = replaced(text, "region = \"z-\"", "region = \"clamped end\"");
  const Case c = read_case(folder.write("case.toml", text));
  CHECK(std::get<MeshFile>(c.body).path == (folder.path / "bar.geo").string());
  CHECK(std::get<MeshFile>(c.body).where.line == 6);
  CHECK(c.fixed[0].region.name == "clamped end");
}

TEST_CASE("a mistake in a case file is refused with its line, its key, its value and what is allowed") {
  const std::string load = "region = \"z+\"\nkind = \"nodal_force\"\nvalue = [0.002, 0, 0.0]\n";
  const std::string material = "model = \"linear_elastic\"\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  const std::string fem = "formulation = \"log_strain\"\nelement = \"q1_bbar\"\nrefine = 1\n";
  const std::string msm = "design = \"moduli\"\npoissons_ratio = 0.3\nsplit = 0.8\n";
  const std::string measure = "kind = \"tilt\"\ntop = \"z+ x- y-\"\nbottom = \"z- x- y-\"\ntoward = \"x\"\n";
  const std::vector<Mistake> mistakes{
      // the document
      {"schema = 1", "schema = 2", 1, "schema", {"is 2", "must be 1"}},
      {"schema = 1", "schema = \"1\"", 1, "schema", {"is \"1\"", "must be 1"}},
      {"schema = 1\n", "", 1, "schema", {"is missing"}},
      {"schema = 1\n", "schem = 1\n", 1, "schem", {"is not a key here", "did you mean \"schema\"?"}},
      {"name = \"cube-shear-small\"", "name = \"cube\nshear\"", 2, "", {"is not valid TOML"}},
      {"[body]", "[body", 4, "", {"is not valid TOML"}},
      {"cells = [10, 10, 10]",
       "cells = [10, 10, 10]\nshape = \"box\"",
       8,
       "",
       {"is not valid TOML", "shape"}},
      {"name = \"cube-shear-small\"", "name = \"\"", 2, "name", {"not empty"}},
      {"name = \"cube-shear-small\"", "name = \"  \"", 2, "name", {"not empty"}},
      {"name = \"cube-shear-small\"", "name = \"../cube\"", 2, "name", {"is \"../cube\"", "without /"}},
      {"name = \"cube-shear-small\"", "name = 3", 2, "name", {"is 3", "a text"}},
      {"description = \"Shear of the cube.\"",
       "descripton = \"Shear\"",
       3,
       "descripton",
       {"did you mean \"description\"?"}},
      {"description = \"Shear of the cube.\"",
       "author = \"me\"",
       3,
       "author",
       {"is not a key here", "allowed are", "description"}},
      {"[body]\n", "", 1, "body", {"is missing", "[body]"}}, // its keys fall to the top level
      // body
      {"[body]", "[boddy]", 4, "boddy", {"did you mean \"body\"?"}},
      {"shape = \"box\"",
       "shape = \"bax\"",
       5,
       "body.shape",
       {"is \"bax\"", "\"box\" | \"mesh\"", "did you mean \"box\"?"}},
      {"shape = \"box\"\n", "", 4, "body.shape", {"is missing", "\"box\" | \"mesh\""}},
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
      {"shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = \"mesh\"\nfile = \"no.msh\"",
       6,
       "body.file",
       {"is \"no.msh\"", "there is no"}},
      {"shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = \"mesh\"\nfile = \"bar.stl\"",
       6,
       "body.file",
       {".msh or .geo"}},
      {"shape = \"box\"", "shape = \"box\"\nfile = \"a.msh\"", 6, "body.file", {"is not a key here"}},
      {"shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = \"voxels\"\nsurface = \"no.stl\"\nedge = 1",
       6,
       "body.surface",
       {"is \"no.stl\"", "there is no"}},
      {"shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]",
       "shape = \"voxels\"\nsurface = \"no.obj\"\nedge = 1",
       6,
       "body.surface",
       {"a closed surface in STL"}},
      // materials of regions
      {"[[fixed]]",
       "[[region_material]]\n[[fixed]]",
       12,
       "region_material[0].axis",
       {"is missing", "one of group, box"}},
      {"[[fixed]]",
       "[[region_material]]\naxis = \"z\"\n[[fixed]]",
       12,
       "region_material[0].from",
       {"is missing", "where the layer ends"}},
      {"[[fixed]]",
       "[[region_material]]\naxis = \"z\"\nfrom = 8\nto = 8\n[[fixed]]",
       15,
       "region_material[0].to",
       {"above from"}},
      {"[[fixed]]",
       "[[region_material]]\nbox = [[0, 0, 0], [1, 1, 0]]\n[[fixed]]",
       13,
       "region_material[0].box",
       {"two corners, the lower first"}},
      {"[[fixed]]",
       "[[region_material]]\ngroup = \"fat\"\n[[fixed]]",
       13,
       "region_material[0].group",
       {"shape = \"mesh\""}},
      {"[[fixed]]",
       "[[region_material]]\naxis = \"z\"\nfrom = 8\nmodel = \"ogden\"\nmu = [1]\nalpha = [2]\n[[fixed]]",
       15,
       "region_material[0].model",
       {"is \"ogden\"", "\"linear_elastic\" as in [material]"}},
      // patches
      {"region = \"z+\"", "region = \"z+\"\nradius = 1", 16, "load[0].radius", {"left out without near"}},
      {"region = \"z+\"", "near = [5, 5, 10]\nradius = 0", 16, "load[0].radius", {"a number above 0"}},
      // what is left open
      {"formulation = \"log_strain\"",
       "formulation = \"autom\"",
       19,
       "fem.formulation",
       {"is \"autom\"", "did you mean \"auto\"?"}},
      {"refine = 1", "accuracy = \"fine\"", 21, "fem.accuracy", {"\"auto\""}},
      {"refine = 1", "refine = 1\naccuracy = \"auto\"", 21, "fem.refine", {"accuracy = \"auto\" finds it"}},
      // material
      {"model = \"linear_elastic\"",
       "model = \"linear_elastik\"",
       9,
       "material.model",
       {"\"linear_elastic\" | \"ogden\"", "did you mean \"linear_elastic\"?"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = 0",
       10,
       "material.youngs_modulus",
       {"is 0", "above 0 (MPa)"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = inf",
       10,
       "material.youngs_modulus",
       {"is inf", "above 0 (MPa)"}},
      {"youngs_modulus = 0.3",
       "youngs_modulus = \"soft\"",
       10,
       "material.youngs_modulus",
       {"is \"soft\"", "a number"}},
      {"youngs_modulus = 0.3",
       "young_modulus = 0.3",
       10,
       "material.young_modulus",
       {"did you mean \"youngs_modulus\"?"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = 0.5",
       11,
       "material.poissons_ratio",
       {"is 0.5", "below 0.5", "ogden"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = -1.0",
       11,
       "material.poissons_ratio",
       {"is -1.0", "above -1"}},
      {"poissons_ratio = 0.35",
       "poissons_ratio = 0.35\nmu = [1]",
       12,
       "material.mu",
       {"is not a key here", "youngs_modulus"}},
      {material,
       "model = \"ogden\"\nmu = [0.1, 0.1]\nalpha = [2]\n",
       11,
       "material.alpha",
       {"is [2]", "as many", "2"}},
      {material, "model = \"ogden\"\nmu = [0.1, -0.1]\nalpha = [2, 4]\n", 10, "material.mu", {"sum above 0"}},
      {material, "model = \"ogden\"\nmu = [0.1]\nalpha = [0.0]\n", 11, "material.alpha", {"none 0"}},
      {material, "model = \"ogden\"\nmu = []\nalpha = []\n", 10, "material.mu", {"one or more"}},
      {material,
       "model = \"ogden\"\nmu = [0.1]\nalpha = [2]\nbulk_modulus = -3\n",
       12,
       "material.bulk_modulus",
       {"is -3"}},
      {material,
       "model = \"ogden\"\nmu = [0.1]\nalpha = [2]\npoissons_ratio = 0.4\n",
       12,
       "material.poissons_ratio",
       {"is not a key here", "bulk_modulus"}},
      // fixed and symmetry
      {"[[fixed]]\nregion = \"z-\"\n", "", 1, "fixed", {"is missing", "nothing holds the body"}},
      {"[[fixed]]", "[fixed]", 12, "fixed", {"is a table", "one or more tables [[fixed]]"}},
      {"[[fixed]]", "[[fixd]]", 12, "fixd", {"did you mean \"fixed\"?"}},
      {"region = \"z-\"", "region = \"w-\"", 13, "fixed[0].region", {"is \"w-\"", "a face \"x-\""}},
      {"region = \"z-\"", "region = \"z- z+\"", 13, "fixed[0].region", {"z- and z+ do not"}},
      {"region = \"z-\"", "region = \"z- z-\"", 13, "fixed[0].region", {"faces that meet"}},
      {"region = \"z-\"", "region = \"near 1 2\"", 13, "fixed[0].region", {"near x y z"}},
      {"region = \"z-\"", "region = \"near 1 2 nan\"", 13, "fixed[0].region", {"near x y z"}},
      {"region = \"z-\"", "near = [1, 2]", 13, "fixed[0].near", {"three finite numbers"}},
      {"region = \"z-\"",
       "region = \"z-\"\nnear = [1, 2, 3]",
       14,
       "fixed[0].near",
       {"left out beside region"}},
      {"region = \"z-\"", "", 12, "fixed[0].region", {"is missing"}},
      {"region = \"z-\"",
       "region = \"z-\"\ncomponents = [\"x\", \"x\"]",
       14,
       "fixed[0].components",
       {"each once"}},
      {"region = \"z-\"",
       "region = \"z-\"\ncomponents = \"x\"",
       14,
       "fixed[0].components",
       {"one to three of"}},
      {"[[fixed]]\nregion = \"z-\"",
       "[[symmetry]]\nplane = \"z\"",
       13,
       "symmetry[0].plane",
       {"is \"z\"", "\"x-\" | \"x+\""}},
      {"[[fixed]]\nregion = \"z-\"",
       "[[symmetry]]\nplane = \"z-\"\n[[symmetry]]\nplane = \"z-\"",
       15,
       "symmetry[1].plane",
       {"another plane than symmetry[0]"}},
      // load
      {"[[load]]\n" + load, "", 1, "load", {"is missing", "[[load]]"}},
      {"kind = \"nodal_force\"",
       "kind = \"nodal_farce\"",
       16,
       "load[0].kind",
       {"total_force", "did you mean \"nodal_force\"?"}},
      {"value = [0.002, 0, 0.0]",
       "value = [0.002, \"0\", 0.0]",
       17,
       "load[0].value",
       {"three finite numbers (N)"}},
      {"value = [0.002, 0, 0.0]",
       "value = [0.002, 0, -inf]",
       17,
       "load[0].value",
       {"-inf", "three finite numbers (N)"}},
      {"value = [0.002, 0, 0.0]", "value = [0, 0, 0]", 17, "load[0].value", {"other than 0"}},
      {"value = [0.002, 0, 0.0]",
       "vlaue = [0.002, 0, 0.0]",
       17,
       "load[0].vlaue",
       {"did you mean \"value\"?"}},
      {"value = [0.002, 0, 0.0]",
       "value = [0.002, 0, 0.0]\naxis = \"z\"",
       18,
       "load[0].axis",
       {"is not a key here"}},
      {load,
       "region = \"z+ x+\"\nkind = \"traction\"\nvalue = [1, 0, 0]\n",
       15,
       "load[0].region",
       {"no area", "traction"}},
      {load,
       "near = [10, 10, 10]\nkind = \"traction\"\nvalue = [1, 0, 0]\n",
       15,
       "load[0].near",
       {"no area"}},
      {load,
       "region = \"z+\"\nkind = \"torque\"\nvalue = [1, 0, 0]\n",
       17,
       "load[0].value",
       {"one finite number", "N mm"}},
      {load,
       "region = \"z+\"\nkind = \"torque\"\nvalue = 1\naxis = \"w\"\n",
       18,
       "load[0].axis",
       {"\"x\" | \"y\" | \"z\""}},
      {load,
       "region = \"z+\"\nkind = \"torque\"\nvalue = 1\naxis = [0,0,0]\n",
       18,
       "load[0].axis",
       {"not all 0"}},
      {load,
       "region = \"z+\"\nkind = \"torque\"\nvalue = 1\naxis = \"z\"\n",
       14,
       "load[0].centre",
       {"is missing"}},
      // moved
      {load,
       "region = \"z+\"\nkind = \"nodal_force\"\nvalue = [1, 0, 0]\n[[moved]]\nregion = \"z+\"\n",
       18,
       "moved[0].displacement",
       {"is missing", "angle"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\ndisplacement = [1, 0]\n",
       20,
       "moved[0].displacement",
       {"three finite numbers"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\ncomponents = [\"z\"]\ndisplacement = [1, 0, 2]\n",
       21,
       "moved[0].displacement",
       {"0 in the components that are not moved"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\ndisplacement = [1, 0, 0]\naxis = \"z\"\n",
       21,
       "moved[0].axis",
       {"left out without angle"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\ndisplacement = [1, 0, 0]\nangle = 90\n",
       20,
       "moved[0].displacement",
       {"left out beside angle"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\nangle = 90\naxis = \"z\"\n",
       18,
       "moved[0].centre",
       {"is missing"}},
      {load,
       load + "[[moved]]\nregion = \"z+\"\nangle = 0\naxis = \"z\"\ncentre = [0, 0, 0]\n",
       20,
       "moved[0].angle",
       {"other than 0"}},
      {"[[load]]\n" + load,
       "[[moved]]\nregion = \"z+\"\ndisplacement = [0, 0, 0]\n",
       1,
       "load",
       {"is missing", "[[moved]]"}},
      // fem
      {"formulation = \"log_strain\"",
       "formulation = \"log-strain\"",
       19,
       "fem.formulation",
       {"did you mean \"log_strain\"?"}},
      {"element = \"q1_bbar\"", "element = \"q3\"", 20, "fem.element", {"is \"q3\"", "q2_p1"}},
      {"element = \"q1_bbar\"", "elment = \"q1_bbar\"", 20, "fem.elment", {"did you mean \"element\"?"}},
      {"refine = 1", "refine = -1", 21, "fem.refine", {"is -1", "from 0 to 8"}},
      {"refine = 1", "refine = 1.0", 21, "fem.refine", {"is 1.0", "whole number"}},
      {"refine = 1", "refine = true", 21, "fem.refine", {"is true", "whole number"}},
      {"refine = 1", "refine = 8", 21, "fem.refine", {"is 8", "fewer"}},
      {fem, "formulation = \"hyperelastic\"\n", 19, "fem.formulation", {"ogden"}},
      {fem,
       "formulation = \"saint_venant_kirchhoff\"\nelement = \"q1_bbar\"\n",
       20,
       "fem.element",
       {"\"q1\" | \"q2\""}},
      {fem,
       "formulation = \"saint_venant_kirchhoff\"\nelement = \"q2_p1\"\n",
       20,
       "fem.element",
       {"\"q1\" | \"q2\""}},
      {"[fem]",
       "fem = 3\n[fim]",
       18,
       "load[0].fem",
       {"is not a key here"}}, // it belongs to the load above it
      // msm
      {"design = \"moduli\"",
       "design = \"modulus\"",
       23,
       "msm.design",
       {"linear_method", "did you mean \"moduli\"?"}},
      {"poissons_ratio = 0.3\nsplit",
       "poissons_ratio = 0.7\nsplit",
       24,
       "msm.poissons_ratio",
       {"is 0.7", "below 0.5"}},
      {"split = 0.8", "split = 1.2", 25, "msm.split", {"is 1.2", "from 0 to 1"}},
      {"design = \"moduli\"",
       "design = \"linear_method\"",
       25,
       "msm.split",
       {"left out", "\"moduli\" | \"hybrid\""}},
      {"split = 0.8", "paths = [\"uniaxial\"]", 25, "msm.paths", {"left out", "\"multi_load\""}},
      {"split = 0.8",
       "strain_range = [0, 0.1]",
       25,
       "msm.strain_range",
       {"left out", "\"nonlinear_method\""}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\npaths = [\"uniaxal\"]",
       24,
       "msm.paths[0]",
       {"did you mean \"uniaxial\"?"}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\npaths = [\"uniaxial\", \"uniaxial\"]",
       24,
       "msm.paths[1]",
       {"not in the list yet"}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\npaths = [\"uniaxial\"]\nweights = [1, 2]",
       25,
       "msm.weights",
       {"is [1, 2]", "1 numbers"}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\nweights = [0, 0, 0, 0]",
       24,
       "msm.weights",
       {"not all 0"}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\nstrain_range = [0.2, 0.1]",
       24,
       "msm.strain_range",
       {"the smaller first"}},
      {"design = \"moduli\"",
       "design = \"multi_load\"\nvolume_term = \"fited\"",
       24,
       "msm.volume_term",
       {"did you mean \"fitted\"?"}},
      {"split = 0.8", "solver = \"newtn\"", 25, "msm.solver", {"\"fire\"", "did you mean \"newton\"?"}},
      {"split = 0.8", "stiffness = [1, 2, 3]", 25, "msm.stiffness", {"left out", "\"given\""}},
      {"split = 0.8", "volume_stiffness = 0.1", 25, "msm.volume_stiffness", {"left out", "\"given\""}},
      {msm, "design = \"given\"\n", 22, "msm.stiffness", {"is missing", "k_e, k_f, k_d"}},
      {msm, "design = \"given\"\nstiffness = [1, 2]\n", 24, "msm.stiffness", {"is [1, 2]", "three numbers"}},
      {msm, "design = \"given\"\nstiffness = [1, -2, 3]\n", 24, "msm.stiffness", {"none below 0"}},
      {msm, "design = \"given\"\nstiffness = [0, 0, 0]\n", 24, "msm.stiffness", {"one is above 0"}},
      {msm,
       "design = \"given\"\nstiffness = [1, 2, 3]\nvolume_stiffness = -1\n",
       25,
       "msm.volume_stiffness",
       {"is -1"}},
      {msm,
       "design = \"given\"\nstiffness = [1, 2, 3]\npoissons_ratio = 0.3\n",
       25,
       "msm.poissons_ratio",
       {"left out"}},
      {msm, "design = \"hybrid\"\npoissons_ratio = 0.2\n", 23, "msm.design", {"0.25 and more", "0.2"}},
      // measure
      {"name = \"alpha_1\"\n", "", 26, "measure[0].name", {"is missing"}},
      {"kind = \"tilt\"", "kind = \"tild\"", 28, "measure[0].kind", {"coordinate", "did you mean \"tilt\"?"}},
      {"top = \"z+ x- y-\"", "top = \"z+ z- y-\"", 29, "measure[0].top", {"z+ and z- do not"}},
      {"toward = \"x\"", "toward = \"x+\"", 31, "measure[0].toward", {"is \"x+\"", "\"x\" | \"y\" | \"z\""}},
      {"toward = \"x\"", "toward = \"z\"", 31, "measure[0].toward", {"another axis than up"}},
      {"toward = \"x\"", "toward = \"x\"\nup = \"up\"", 32, "measure[0].up", {"is \"up\""}},
      {"bottom = \"z- x- y-\"", "bottom = \"z+ x- y-\"", 29, "measure[0].top", {"another node than bottom"}},
      {"toward = \"x\"",
       "toward = \"x\"\nnode = \"z+\"",
       32,
       "measure[0].node",
       {"is not a key here", "toward"}},
      {"toward = \"x\"\n",
       "toward = \"x\"\n[[measure]]\nname = \"alpha_1\"\nkind = \"volume\"\n",
       33,
       "measure[1].name",
       {"is \"alpha_1\"", "measure[0]"}},
      {measure, "kind = \"coordinate\"\nnode = \"z+\"\n", 26, "measure[0].axis", {"is missing"}},
      {measure,
       "kind = \"displacement\"\nnode = \"z+\"\ncomponent = \"w\"\n",
       30,
       "measure[0].component",
       {"\"norm\""}},
      {measure,
       "kind = \"twist\"\nnode = \"near 5 5 10\"\ncentre = \"near 5 5 10\"\n",
       29,
       "measure[0].node",
       {"another node than centre"}},
      // expect
      {"measure = \"alpha_1\"",
       "measure = \"alpha_2\"",
       33,
       "expect[0].measure",
       {"is \"alpha_2\"", "did you mean \"alpha_1\"?"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [0.0, -8.0]",
       34,
       "expect[0].error_percent",
       {"lower <= upper"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [0.0]",
       34,
       "expect[0].error_percent",
       {"two finite numbers"}},
      {"error_percent = [-8.0, 0.0]\n", "", 32, "expect[0].error_percent", {"is missing", "msm", "fem"}},
      {"error_percent = [-8.0, 0.0]",
       "error_percent = [-8.0, 0.0]\nfem = [1, 2]",
       35,
       "expect[0].fem",
       {"left out"}},
      {"reference = \"published\"",
       "reference = \"printed\"",
       35,
       "expect[0].reference",
       {"exact", "regression"}},
      {"reason = \"Table 4.5\"", "reason = \"\"", 36, "expect[0].reason", {"not empty"}},
      {"reason = \"Table 4.5\"\n", "", 32, "expect[0].reason", {"is missing"}},
  };
  for (const Mistake& mistake : mistakes)
    check_refused(replaced(good_case, mistake.from, mistake.to), mistake);
}

TEST_CASE("a nearly incompressible material is refused for elements that lock and for the linear method") {
  const std::string ogden = R"(schema = 1
name = "bar"
[body]
shape = "box"
size = [4, 4, 16]
cells = [4, 4, 16]
[material]
model = "ogden"
mu = [0.04]
alpha = [5.7]
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0, 0, 0.01]
)";
  check_refused(ogden + "[fem]\nelement = \"q1\"\n", {"", "", 18, "fem.element", {"q1_p0", "locks"}});
  check_refused(ogden + "[fem]\nformulation = \"log_strain\"\n",
                {"", "", 18, "fem.formulation", {"hyperelastic"}});
  check_refused(ogden + "[msm]\ndesign = \"linear_method\"\n",
                {"", "", 18, "msm.design", {"Poisson's ratio below 0.5"}});
  CHECK_NOTHROW(read_text_as_case(ogden + "[msm]\ndesign = \"linear_method\"\npoissons_ratio = 0.35\n"));
  CHECK_NOTHROW(read_text_as_case(ogden + "[fem]\nelement = \"q1_bbar\"\n"));
}

TEST_CASE("a file that cannot be read is named, with the reason") {
  CHECK_THROWS_WITH(read_case("/no/such/case.toml"),
                    Catch::StartsWith("/no/such/case.toml: cannot be read: No such file"));
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(read_case(folder.path.string()), Catch::Contains("cannot be read"));
}

TEST_CASE("settings of the command line replace and add values") {
  const Case c = read_text_as_case(
      good_case, {"load[0].value=[0, 0, 0.01]", "fem.element=q1", "fem.refine = 0", "measure[0].top=z+ x+ y-",
                  "measure[0].bottom = \"z- x+ y-\"", "name=a b", "msm={design=\"given\", stiffness=[1,2,3]}",
                  "expect[0].error_percent=[-1,1]"});
  CHECK(c.loads[0].value == Eigen::Vector3d(0, 0, 0.01));
  CHECK(c.fem.element == Element::q1);
  CHECK(c.fem.refine == 0);
  CHECK(c.measures[0].top.name == "z+ x+ y-");
  CHECK(c.measures[0].bottom.name == "z- x+ y-");
  CHECK(c.name == "a b");
  CHECK(c.msm.design == Design::given);
  CHECK(c.expectations[0].interval == std::array<double, 2>{-1, 1});
  const Case single = read_text_as_case(good_case, {"load[0].value[2]=0.5"});
  CHECK(single.loads[0].value == Eigen::Vector3d(0.002, 0, 0.5));
}

TEST_CASE("a mistake in a setting of the command line is told as such") {
  const std::vector<std::pair<std::string, std::string>> settings{
      {"fem.element=q9", "command line: fem.element: is \"q9\", must be \"q1\""},
      {"fem.elment=q1", "command line: fem.elment: is not a key here"},
      {"fem.refine=1e", "command line: fem.refine: is \"1e\", must be a whole number"},
      {"fem.refine=2\nname='x'", "command line: fem.refine: is"},
      {"load[1].value=[0,0,1]", "command line: load[1].value: there is no load[1], load has 1 elements"},
      {"load[0].value=[0,0", "command line: load[0].value: is \"[0,0\", must be"},
      {"load[x].value=1", "command line: load[x].value: is not a key"},
      {"name.first=1", "command line: name.first: name is not a table"},
      {"fem..refine=1", "command line: fem..refine: is not a key"},
      {"fem.refine", "command line: fem.refine: is not KEY=VALUE"},
      {"fem.refine=", "command line: fem.refine: has no value"},
      {"=1", "command line: is not a key"},
      {"material.poissons_ratio=0.5", "command line: material.poissons_ratio: is 0.5, must be"},
      {"schema=nan", "command line: schema: is nan, must be 1"},
  };
  for (const auto& [setting, message] : settings) {
    INFO(setting);
    CHECK_THROWS_WITH(read_text_as_case(good_case, {setting}), Catch::StartsWith(message));
  }
}

TEST_CASE("a region is moved along, or turned about an axis, and then no load is needed") {
  const std::string loads = "[[load]]\nregion = \"z+\"\nkind = \"nodal_force\"\nvalue = [0.002, 0, 0.0]\n";
  const Case pressed = read_text_as_case(replaced(
      good_case, loads, "[[moved]]\nregion = \"z+\"\ncomponents = [\"z\"]\ndisplacement = [0, 0, -5]\n"));
  REQUIRE(pressed.moved.size() == 1);
  CHECK(pressed.loads.empty());
  CHECK(pressed.moved[0].components == std::array<bool, 3>{false, false, true});
  CHECK(pressed.moved[0].displacement == Eigen::Vector3d(0, 0, -5));
  CHECK(pressed.moved[0].angle == 0);
  const Case turned = read_text_as_case(replaced(
      good_case, loads, "[[moved]]\nregion = \"z+\"\nangle = 90\naxis = \"z\"\ncentre = [5, 5, 10]\n"));
  REQUIRE(turned.moved.size() == 1);
  CHECK(turned.moved[0].angle == 90);
  CHECK(turned.moved[0].axis == Eigen::Vector3d::UnitZ());
  CHECK(turned.moved[0].centre == Eigen::Vector3d(5, 5, 10));
}

TEST_CASE("every case file of the project is read, and its regions exist") {
  int n = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SPRINGPROOF_SOURCE_DIR) / "cases")) {
    if (entry.path().extension() != ".toml") continue;
    if (entry.path().parent_path().filename() == "templates") continue; // no cases yet: see command_test.cpp
    INFO(entry.path().string());
    ++n;
    if (entry.path().parent_path().filename() != "hard") {
      CHECK_NOTHROW(make_scene(read_case(entry.path().string())));
      continue;
    }
    HardCase hard;
    CHECK_NOTHROW(hard = read_hard_case(entry.path().string()));
    CHECK(hard.definition.name == entry.path().stem().string()); // they are asked for by it
    CHECK(hard.definition.description.size() > 40);              // a sentence
    const bool is_refused = hard.expected.at(0).outcome == Outcome::refused;
    if (is_refused) CHECK_THROWS_AS(make_scene(hard.definition), InputError);
    if (!hard.is_heavy && !is_refused) CHECK_NOTHROW(make_scene(hard.definition));
  }
  CHECK(n >= 12); // the thesis's cube alone: two materials, three tests, two load sets
}

TEST_CASE("materials of regions, patches and voxel bodies are read") {
  const TemporaryFolder folder;
  folder.write("body.stl", "");
  std::string text = replaced(good_case, "shape = \"box\"\nsize = [10.0, 10.0, 10]\ncells = [10, 10, 10]\n",
                              "shape = \"voxels\"\nsurface = \"body.stl\"\nedge = 0.5\n");
  text = replaced(text, "region = \"z+\"", "near = [5, 5, 10]\nradius = 2.5");
  text = replaced(
      text, "[[fixed]]",
      "[[region_material]]\nbox = [[0, 1, 2], [3, 4, 5]]\nmodel = \"linear_elastic\"\nyoungs_modulus = 7\n"
      "poissons_ratio = 0.4\n[[region_material]]\naxis = \"y\"\nto = 2\nmodel = \"linear_elastic\"\n"
      "youngs_modulus = 8\npoissons_ratio = 0.4\n[[fixed]]");
  const Case c = read_case(folder.write("case.toml", text));
  CHECK(std::get<Voxels>(c.body).edge == 0.5);
  CHECK(std::get<Voxels>(c.body).path == (folder.path / "body.stl").string());
  REQUIRE(c.region_materials.size() == 2);
  CHECK(c.region_materials[0].lower == Eigen::Vector3d(0, 1, 2));
  CHECK(c.region_materials[0].upper == Eigen::Vector3d(3, 4, 5));
  CHECK(std::get<LinearElastic>(c.region_materials[0].material).youngs_modulus == 7);
  CHECK(c.region_materials[1].upper.y() == 2);
  CHECK(std::isinf(c.region_materials[1].lower.y()));
  CHECK(std::isinf(c.region_materials[1].upper.x()));
  CHECK(c.loads[0].region.radius == 2.5);
}

TEST_CASE("every material must suit the element and the springs' design") {
  const std::string other =
      "[[region_material]]\naxis = \"z\"\nfrom = 5\nmodel = \"linear_elastic\"\nyoungs_modulus = 1\n"
      "poissons_ratio = 0.1\n[[fixed]]";
  const std::string text = replaced(good_case, "[[fixed]]", other);
  CHECK_NOTHROW(read_text_as_case(text));
  const auto with = [&](const std::string& design) {
    return replaced(text, "design = \"moduli\"\npoissons_ratio = 0.3\nsplit = 0.8\n", design);
  };
  CHECK_THROWS_WITH(read_text_as_case(with("design = \"hybrid\"\n")),
                    Catch::Contains("region_material[0]") && Catch::Contains("0.25"));
  CHECK_THROWS_WITH(read_text_as_case(with("design = \"given\"\nstiffness = [1, 1, 1]\n")),
                    Catch::Contains("region_material[0]") && Catch::Contains("given"));
}

TEST_CASE(
    "what is left open in the finite elements needs an expectation that says how accurate they must be") {
  const std::string text =
      replaced(replaced(good_case, "refine = 1", "accuracy = \"auto\""), "\"log_strain\"", "\"auto\"");
  const Case c = read_text_as_case(text);
  CHECK(c.fem.has_auto_accuracy);
  CHECK(c.fem.has_auto_formulation);
  CHECK(c.fem.formulation == Formulation::log_strain);
  CHECK(c.fem.refine == 0);
  CHECK_THROWS_WITH(read_text_as_case(replaced(text, "error_percent", "msm")),
                    Catch::Contains("expect") && Catch::Contains("error_percent or fem"));
  const std::string linear = "model = \"linear_elastic\"\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n";
  CHECK_THROWS_WITH(read_text_as_case(replaced(text, linear, "model = \"ogden\"\nmu = [1]\nalpha = [2]\n")),
                    Catch::Contains("fem.formulation") && Catch::Contains("hyperelastic"));
}
