// Standard output is the results' alone, and nobody else's files decide what the program does.

#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace {

const std::string sheared_cube = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/gates/sheared_cube.toml";

} // namespace

TEST_CASE("output that cannot be written is an error of one line") {
  for (const char* lost : {" >/dev/full", " >&-"}) {
    INFO(lost);
    const ProgramRun run = run_program("run --only msm " + sheared_cube + lost);
    CHECK(run.status == 2);
    CHECK(run.error == "springproof: standard output cannot be written\n");
  }
}

TEST_CASE("what PETSc is asked to print does not get into the results") {
  const ProgramRun run = run_program("run --only fem --json " + sheared_cube, "PETSC_OPTIONS=-log_view ");
  CHECK(run.status == 0);
  CHECK(nlohmann::json::accept(run.out));
}

TEST_CASE("options of PETSc in the working folder are not read") {
  const TemporaryFolder folder;
  const std::string view = (folder.path / "view").string();
  folder.write(".petscrc", "-log_view :" + view + "\n-\"\n(((\n");
  const ProgramRun run = run_program("run --only msm " + sheared_cube, "cd " + folder.path.string() + " && ");
  CHECK(run.status == 0);
  CHECK(run.error.empty());
  CHECK_FALSE(std::filesystem::exists(view));
}

// Open MPI would make a folder there that all programs of a user share, and one that ends removes.
TEST_CASE("a program alone makes no folder of MPI's") {
  const ProgramRun run = run_program("run --only msm " + sheared_cube, "TMPDIR=/proc ");
  CHECK(run.status == 0);
  CHECK(run.error.empty());
}
