// Eigenspaces of a cell, as the program prints and writes them.

#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace fs = std::filesystem;

TEST_CASE("eigen --json numbers the spaces from 1 as the thesis does") {
  const auto document = document_of("eigen --poisson 0 --json --body 2 --modes 6");
  CHECK(document["poissons_ratio"] == 0);
  CHECK(document["fem"].size() == 6);
  CHECK(document["msm"].size() == 9);
  CHECK(document["equivalent"][2]["fem_space"] == 5);
  CHECK(document["equivalent"][2]["msm_space"] == 8);
  CHECK(document["equivalent"][2]["distance"] == 5);
  CHECK(document["free_body"].size() > 0);
}

TEST_CASE("eigen takes every material, and an incompressible one with another Poisson's ratio") {
  check_refused("eigen --neo-hookean 0.05", "--poisson");
  const auto h_of = [](const std::string& words) { return document_of(words)["h"].get<double>(); };
  CHECK(h_of("eigen --neo-hookean 0.05 --poisson 0.4 --json") ==
        Approx(h_of("eigen --young 0.15 --poisson 0.4 --json")).epsilon(1e-9)); // 3 mu is Young's modulus
}

TEST_CASE("eigen --out leaves the diagram, the shapes and their pictures", "[long]") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "eigen").string();
  printed_by("eigen --poisson 0.35 --out " + out);
  for (const char* name : {"dot_diagram.csv", "dot_diagram.svg", "dot_diagram.png", "coupling.csv",
                           "fem_modes.vtu", "fem_modes.png", "msm_modes.vtu", "msm_modes.svg"}) {
    CAPTURE(name);
    CHECK(fs::file_size(fs::path(out) / name) > 100);
  }
}
