// Too little memory, too far a turn, nothing to divide by: what the program says of them.

#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

namespace {

const std::string bean = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/studies/bean/bean.stl",
                  gate_case = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/gates/sheared_cube.toml";

/// A box of 1 mm cubes whose lowest face is clamped.
std::string box_case(const std::string& cells, const std::string& more) {
  return "schema = 1\nname = 'box'\n[body]\nshape = 'box'\nsize = " + cells + "\ncells = " + cells +
         "\n[material]\nmodel = 'linear_elastic'\nyoungs_modulus = 0.3\npoissons_ratio = 0.35\n"
         "[[fixed]]\nregion = 'z-'\n" +
         more;
}

} // namespace

TEST_CASE("too little address space for the libraries is told at once, in one line") {
  for (const char* kilobytes : {"200000", "260000", "330000"})
    for (const std::string& words : {"run --only msm " + gate_case, std::string("--version")})
      check_refused(words, "ulimit -v leaves", std::string("ulimit -v ") + kilobytes + "; ");
  // Those behind deal.II and PETSc need more.
  for (const char* kilobytes : {"450000", "620000", "740000", "860000"}) {
    const std::string limit = std::string("ulimit -v ") + kilobytes + "; ";
    check_refused("run " + gate_case, "ulimit -v leaves", limit);
    CHECK(run_program("run --only msm " + gate_case, limit).status == 0);
  }
}

TEST_CASE("a body too large for memory is refused before its mesh is made, whatever makes the mesh") {
  const TemporaryFolder folder;
  const std::string load = "[[load]]\nregion = 'z+'\nkind = 'traction'\nvalue = [0.001, 0, 0]\n",
                    huge = folder.write("huge.toml", box_case("[600, 600, 600]", load)),
                    small = folder.write("small.toml", box_case("[2, 2, 2]", load));
  std::string body = content(small), voxels = "shape = 'voxels'\nedge = 0.07\nsurface = '" + bean + "'\n";
  body.replace(body.find("shape"), body.find("[material]") - body.find("shape"), voxels);
  const std::string fine = folder.write("fine.toml", body);
  const std::string limit = "ulimit -v 1500000; ";
  for (const std::string& words :
       {"run " + huge, "gate " + huge, "run " + fine, "gate " + fine, "run --set fem.refine=8 " + small,
        "design --case " + huge, "eigen --case " + huge, "design --case " + fine})
    check_refused(words, " of memory, and ulimit -v leaves ", limit);
}

TEST_CASE("gate holds both models to the same turn, most of a whole one", "[long]") {
  const TemporaryFolder folder;
  for (const int angle : {300, 360}) {
    const std::string quarter = std::to_string(angle / 4 - 5) + ", " + std::to_string(angle / 4 + 5);
    std::string more =
        "[[moved]]\nregion = 'z+'\naxis = 'z'\ncentre = [1, 1, 12]\nangle = " + std::to_string(angle) +
        "\n[fem]\naccuracy = 'none'\n[msm]\ndesign = 'hybrid'\n"
        "[[measure]]\nname = 'quarter'\nkind = 'twist'\nnode = 'near 2 1 3'\ncentre = 'near 1 1 3'\n";
    for (const char* side : {"msm", "fem"})
      more +=
          std::string(
              "[[expect]]\nmeasure = 'quarter'\nreference = 'exact'\nreason = 'a bar, but for its ends'\n") +
          side + " = [" + quarter + "]\n";
    printed_by("gate " + folder.write("turned.toml", box_case("[2, 2, 12]", more)));
  }
}

TEST_CASE("small strains refuse more than half a turn, and auto does not choose them for it") {
  const TemporaryFolder folder;
  const auto turned = [&](const std::string& formulation) {
    return folder.write(
        formulation + ".toml",
        box_case("[2, 2, 12]", "[[moved]]\nregion = 'z+'\naxis = 'z'\ncentre = [1, 1, 12]\nangle = 360\n"
                               "[fem]\naccuracy = 'none'\nformulation = '" +
                                   formulation +
                                   "'\n[[measure]]\nname = 'volume'\nkind = 'volume'\n[[expect]]\nmeasure = "
                                   "'volume'\nfem = [40, 60]\nreference = 'exact'\nreason = 'any'\n"));
  };
  check_refused("run " + turned("small_strain"), "must be at most 180");
  CHECK_THAT(printed_by("run --only fem " + turned("auto")),
             Catch::Contains("a region is turned by 360 degrees"));
}

TEST_CASE(
    "gate does not pass a column that stands straight beyond Euler's load, unless its case accepts it") {
  const TemporaryFolder folder;
  const auto gate = [&](const std::string& accept) {
    return run_program(
        "gate " +
        folder.write("column.toml",
                     box_case("[1, 1, 12]", // Euler's load is 0.0004 N
                              "[[load]]\nregion = 'z+'\nkind = 'traction'\nvalue = [0, 0, -0.003]\n"
                              "[fem]\naccuracy = 'none'\n" +
                                  accept +
                                  "[[measure]]\nname = 'top'\nkind = 'coordinate'\nnode = 'z+ x+ y+'\n"
                                  "axis = 'z'\n[[expect]]\nmeasure = 'top'\nfem = [0, 12]\n"
                                  "reference = 'exact'\nreason = 'pressed'\n")));
  };
  const ProgramRun refused = gate("");
  CHECK(refused.status == 1);
  CHECK_THAT(refused.out, Catch::Contains("fem is in an unstable equilibrium"));
  CHECK(gate("accept = ['unstable']\n").status == 0);
}

TEST_CASE("a reference that is zero but for rounding has no percentage") {
  const TemporaryFolder folder;
  const std::string file = folder.write(
      "zero.toml",
      box_case("[2, 2, 2]", "[[load]]\nregion = 'z+'\nkind = 'traction'\nvalue = [0.001, 0, 0]\n"
                            "[fem]\naccuracy = 'none'\n"
                            "[[measure]]\nname = 'across'\nkind = 'displacement'\nnode = 'near 1 "
                            "1 2'\ncomponent = 'y'\n[[measure]]\nname = 'along'\nkind = "
                            "'displacement'\nnode = 'near 1 1 2'\ncomponent = 'x'\n"));
  CHECK_THAT(run_program("run " + file).out, Catch::Contains("no percentage"));
  const auto measures = document_of("run --json " + file).at("cases").at(0).at("measures");
  CHECK(measures.at(0).at("error_percent").is_null());
  CHECK(measures.at(1).at("error_percent").is_number());
}
