#include "cases/case/read_case.hpp"
#include "tests/support/case_text.hpp"

using namespace springproof;

using namespace cases;
using namespace case_text;

TEST_CASE("a body of a mesh file takes the names of groups as regions, and finds the file beside the case") {
  const TemporaryFolder folder;
  folder.write("bar.geo", "");
  std::string text = replaced(good_case, box_keys + "\n", "shape = 'mesh'\nfile = 'bar.geo'\n");
  text = replaced(text, "region = 'z-'", "region = 'clamped end'");
  const Case c = read_case(folder.write("case.toml", text));
  CHECK(std::get<MeshFile>(c.body).file.path == (folder.path / "bar.geo").string());
  CHECK(std::get<MeshFile>(c.body).file.where.line == 6);
  CHECK(c.fixed[0].region.name == "clamped end");
}

TEST_CASE("a mesh of VTK's names its groups, and a surface says what fills it") {
  const TemporaryFolder folder;
  folder.write("a.vtu", "");
  folder.write("a.msh", "");
  folder.write("a.obj", "");
  const auto read = [&](const std::string& body) {
    return read_case(folder.write("case.toml", replaced(good_case, box_keys + "\n", body))).body;
  };
  CHECK(std::get<MeshFile>(read("shape = 'mesh'\nfile = 'a.vtu'\ngroups = 'zone'\n")).cell_groups == "zone");
  CHECK_THROWS_WITH(read("shape = 'mesh'\nfile = 'a.msh'\ngroups = 'zone'\n"),
                    Catch::Contains("body.groups") && Catch::Contains("physical groups"));
  const auto surface = std::get<FilledSurface>(
      read("shape = 'surface'\nfile = 'a.obj'\nsize = 2\nscale = 1000\nfill = 'cubes'\n"));
  CHECK(surface.size == 2);
  CHECK(surface.scale == 1000);
  CHECK(surface.fill == Fill::cubes);
  CHECK(std::get<FilledSurface>(read("shape = 'surface'\nfile = 'a.obj'\nsize = 2\n")).fill == Fill::cubes);
  CHECK_THROWS_WITH(read("shape = 'surface'\nfile = 'a.obj'\n"), Catch::Contains("body.size"));
}

TEST_CASE("a body of voxels is read, and finds its surface beside the case") {
  const TemporaryFolder folder;
  folder.write("body.stl", "");
  const Case c =
      read_case(folder.write("case.toml", replaced(good_case, box_keys + "\n",
                                                   "shape = 'voxels'\nsurface = 'body.stl'\nedge = 0.5\n")));
  CHECK(std::get<Voxels>(c.body).edge == 0.5);
  CHECK(std::get<Voxels>(c.body).file.path == (folder.path / "body.stl").string());
}

namespace {

const std::string labelled =
    "shape = 'labels'\nfile = 'case.toml.nii'\nedge = 1.5\ncrop = [[0, 0, 0], [9, 8, 7]]\n"
    "keep = 'largest'\n[[body.classes]]\nname = 'bone'\nlower = 226\nupper = 3000\n"
    "rigid = true\n[[body.classes]]\nname = 'skin'\nlower = -200\nupper = 225\n";

std::string labelled_case() {
  return replaced(good_case, box_keys + "\n", labelled);
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
  CHECK_THAT(refused("'case.toml.nii'", "'case.toml.dcm'"), Catch::Contains(".nii.gz"));
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

TEST_CASE("a mistake in [body] is refused where it is made") {
  const auto refused = mistakes_in(good_case);
  const std::string size = "size = [10.0, 10.0, 10]", cells = "cells = [10, 10, 10]";
  refused("[body]", "[boddy]", 4, "boddy", {"did you mean \"body\"?"});
  refused("shape = 'box'", "shape = 'bax'", 5, "body.shape",
          {"is \"bax\"", "\"box\" | \"mesh\"", "did you mean \"box\"?"});
  refused("shape = 'box'\n", "", 4, "body.shape", {"is missing", "\"box\" | \"mesh\""});
  refused(size, "sise = [10.0, 10.0, 10]", 6, "body.sise", {"did you mean \"size\"?"});
  refused(size, "size = [10.0, 10.0]", 6, "body.size", {"is [10.0, 10.0]", "three numbers above 0 (mm)"});
  refused(size, "size = [10.0, -1, 10]", 6, "body.size", {"-1", "above 0"});
  refused(size, "size = [10.0, nan, 10]", 6, "body.size", {"nan", "above 0"});
  refused(size, "size = 10", 6, "body.size", {"is 10", "three numbers"});
  refused(cells, "cells = [10, 10.5, 10]", 7, "body.cells", {"10.5", "three whole numbers above 0"});
  refused(cells, "cells = [10, 0, 10]", 7, "body.cells", {"above 0"});
  refused(cells, "cells = [100000, 100000, 10]", 7, "body.cells", {"fewer"});
  refused(box_keys, "shape = 'mesh'\nfile = 'no.msh'", 6, "body.file", {"is \"no.msh\"", "there is no"});
  refused(box_keys, "shape = 'mesh'\nfile = 'bar.stl'", 6, "body.file",
          {".msh or .geo", ".vtu or .vtk", "shape = \"surface\"", "meshio convert"});
  refused(box_keys, "shape = 'mesh'\nfile = 'bar.inp'", 6, "body.file", {"meshio convert"});
  refused(box_keys, "shape = 'surface'\nfile = 'bar.msh'\nsize = 1", 6, "body.file", {"shape = \"mesh\""});
  refused("shape = 'box'", "shape = 'box'\nfile = 'a.msh'", 6, "body.file", {"is not a key here"});
  refused(box_keys, "shape = 'voxels'\nsurface = 'no.stl'\nedge = 1", 6, "body.surface",
          {"is \"no.stl\"", "there is no"});
  refused(box_keys, "shape = 'voxels'\nsurface = 'no.off'\nedge = 1", 6, "body.surface",
          {"a closed surface, .stl, .obj, .ply or .vtp"});
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
  const auto refused = mistakes_in(good_case);
  refused(from, from + "\n[[body.removed]]\nbox = [[1, 2, 3], [1, 5, 6]]", 9, "body.removed[0].box",
          {"lower first"});
  refused(from, from + "\n[[body.removed]]\nbox = [[1, 2, 3], [2, 5, 6]]\njoin = 'w'", 10,
          "body.removed[0].join", {"\"x\""});
}
