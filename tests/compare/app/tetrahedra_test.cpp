// What the program says of a body of tetrahedra.

#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace {

/// Writes a case of a block that is pulled.
std::string block_in(const TemporaryFolder& folder) {
  const std::string file = (folder.path / "case.toml").string();
  std::ofstream(file)
      << "schema = 1\nname = \"block\"\ndescription = \"two materials\"\n[body]\nshape = \"mesh\"\n"
         "file = \""
      << SPRINGPROOF_SOURCE_DIR
      << "/tests/cases/mesh/files/gmsh_41_text.msh\"\n[material]\nmodel = \"linear_elastic\"\n"
         "youngs_modulus = 0.3\npoissons_ratio = 0.3\n[[fixed]]\nregion = \"left\"\n[[load]]\n"
         "kind = \"traction\"\nregion = \"right\"\nvalue = [0.001, 0, 0]\n[[measure]]\n"
         "name = \"volume\"\nkind = \"volume\"\n";
  return file;
}

} // namespace

TEST_CASE(
    "tetrahedra are solved by both models and vibrate; a design of one cell refuses them, and nothing is no "
    "number") {
  const TemporaryFolder folder;
  const std::string file = block_in(folder);
  check_refused("design --case " + file, "springproof design CASE");
  check_refused("run --set fem.element=\"q1\" " + file, "must be \"p2\" | \"p1\" | \"p2_p0\" | \"p2_p1\"");
  CHECK_THAT(printed_by("eigen --set material.density=1000 " + file), !Catch::Contains("nan"));
  CHECK_THAT(printed_by("eigen --set material.density=1000 --set fem.element=p2_p1 " + file),
             !Catch::Contains("nan"));
  CHECK_THAT(printed_by("run " + file), !Catch::Contains("nan"));
  const auto document = document_of("run --json " + file);
  for (const char* side : {"fem", "msm"}) {
    CHECK(document["cases"][0][side]["status"] == "converged");
    CHECK(document["cases"][0]["measures"][0][side].get<double>() ==
          Approx(2).epsilon(0.02)); // hardly loaded
  }
}

TEST_CASE("on tetrahedra run --designs all ranks the designs that design CASE has figures of") {
  const TemporaryFolder folder;
  const std::string file = block_in(folder);
  const auto on_mesh = document_of("design --designs all --json " + file)["designs"];
  const auto ranked = document_of("run --designs all --json " + file)["cases"][0]["designs"];
  REQUIRE(ranked.size() == on_mesh.size());
  const auto n_applied = std::count_if(on_mesh.begin(), on_mesh.end(),
                                       [](const auto& design) { return !design.contains("refused"); });
  CHECK(n_applied == 7);
  for (const auto& design : ranked) {
    CAPTURE(design["design"]);
    const auto same = std::find_if(on_mesh.begin(), on_mesh.end(),
                                   [&](const auto& other) { return other["design"] == design["design"]; });
    REQUIRE(same != on_mesh.end());
    CHECK(design["worst_error_percent"].is_number() == !same->contains("refused"));
  }
}

TEST_CASE("design CASE prints a line for each design, and refuses what is for a single cell") {
  const TemporaryFolder folder;
  const std::string file = block_in(folder), text = printed_by("design " + file);
  CHECK_THAT(text, Catch::Contains("48 tetrahedra, 23 nodes") && Catch::Contains("\n  relaxed  ") &&
                       !Catch::Contains("nan"));
  check_refused("design --young 0.3 " + file, "--young excludes case");
  check_refused("design --designs hybrid --young 0.3 --poisson 0.3", "--designs requires case");
}
