// Eigenspaces of a cell, as the program prints and writes them.

#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace fs = std::filesystem;

TEST_CASE("eigen --json numbers the spaces from 1 as the thesis does") {
  const ProgramRun outcome = run_program("eigen --poisson 0 --json --body 2 --modes 6");
  REQUIRE(outcome.status == 0);
  CHECK(outcome.error.empty());
  const auto document = nlohmann::json::parse(outcome.out);
  CHECK(document["poissons_ratio"] == 0);
  CHECK(document["fem"].size() == 6);
  CHECK(document["msm"].size() == 9);
  CHECK(document["equivalent"][2]["fem_space"] == 5);
  CHECK(document["equivalent"][2]["msm_space"] == 8);
  CHECK(document["equivalent"][2]["distance"] == 5);
  CHECK(document["free_body"].size() > 0);
}

TEST_CASE("eigen takes every material, and an incompressible one with another Poisson's ratio") {
  const ProgramRun refused = run_program("eigen --neo-hookean 0.05"),
                   taken = run_program("eigen --neo-hookean 0.05 --poisson 0.4 --json"),
                   linear = run_program("eigen --young 0.15 --poisson 0.4 --json");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.error, Catch::Contains("--poisson"));
  REQUIRE(taken.status == 0);
  const auto h_of = [](const ProgramRun& run) { return nlohmann::json::parse(run.out)["h"].get<double>(); };
  CHECK(h_of(taken) == Approx(h_of(linear)).epsilon(1e-9)); // 3 mu is Young's modulus
}

TEST_CASE("eigen --out leaves the diagram, the shapes and their pictures", "[long]") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "eigen").string();
  REQUIRE(run_program("eigen --poisson 0.35 --out " + out).status == 0);
  for (const char* name : {"dot_diagram.csv", "dot_diagram.svg", "dot_diagram.png", "coupling.csv",
                           "fem_modes.vtu", "fem_modes.png", "msm_modes.vtu", "msm_modes.svg"}) {
    CAPTURE(name);
    CHECK(fs::file_size(fs::path(out) / name) > 100);
  }
}
