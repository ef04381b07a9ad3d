// Values of options, limits and leftovers that nobody means, and that once went through: one line and exit
// status 2.

#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

namespace fs = std::filesystem;

namespace {

const std::string gated_cube = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/gates/sheared_cube.toml";

} // namespace

// Every option that is a number was looked through; those of integers are refused by CLI11 where they do not
// fit.
TEST_CASE("an option's number is finite and in its range") {
  for (const char* words :
       {"design --young 0 --poisson 0.3", "design --young 1e-320 --poisson 0.3",
        "design --young 1 --poisson inf", "design --young 1 --poisson nan",
        "design --young 1 --poisson 0.3 --method moduli --split -1",
        "design --young 1 --poisson 0.3 --method moduli --split nan",
        "design --young 1 --poisson 0.3 --edge nan", "design --neo-hookean 0",
        "design --ogden-mu nan --ogden-alpha 2", "design --ogden-mu 1 --ogden-alpha inf", "design --yeoh nan",
        "design --mooney-rivlin 1 nan", "design --neo-hookean 1 --strain-range nan 1", "eigen --young 0",
        "eigen --young 1e-300 --poisson 0.3", "eigen --poisson 1e400"}) {
    check_refused(words, "must be a number from");
  }
  check_refused("sweep --quick --budget nan " + gated_cube, "--budget: is nan, must be a number from");
  check_refused("interact --seconds nan " + gated_cube, "--seconds: is nan, must be a number from");
}

TEST_CASE("a limit of a file's size ends in one line, and leaves nothing that is half written") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  for (const char* blocks : {"8", "40", "150"}) { // a block has 1024 bytes in bash, 512 in other shells
    fs::remove_all(out);
    const ProgramRun run = run_program("run " + gated_cube + " --set body.cells=[8,8,8] --out " + out,
                                       "ulimit -f " + std::string(blocks) + "; ");
    CHECK(run.status == 2);
    CHECK_THAT(run.error, Catch::Contains("cannot write"));
    CHECK(std::count(run.error.begin(), run.error.end(), '\n') <= 2);
    if (!fs::exists(out)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(out))
      CHECK(entry.path().extension() != ".springproof-part");
  }
}

TEST_CASE("a limit of a process's data is told before libraries look for memory for ever") {
  for (const char* kilobytes : {"70000", "130000", "250000"})
    check_refused("run " + gated_cube, "ulimit -d leaves", "ulimit -d " + std::string(kilobytes) + "; ");
}

TEST_CASE("too few open files are told before MPI crashes") {
  for (const char* files : {"14", "20", "31"})
    check_refused("run " + gated_cube, "ulimit -n allows", "ulimit -n " + std::string(files) + "; ");
  CHECK(run_program("run " + gated_cube, "ulimit -n 32; ").status == 0);
}

TEST_CASE("a folder without a name is none, and not the root of all folders") {
  for (const char* words :
       {"export --to csv ", "run ", "gate ", "design --young 1 --poisson 0.3 ", "eigen ", "sweep --quick "})
    check_refused(words + (words[0] == 'd' || words[1] == 'i' ? "" : gated_cube) + " --out ''",
                  "--out: names no folder");
}

TEST_CASE("a motion's files are those of the last run") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  std::string text = content(gated_cube);
  text = text.substr(0, text.find("[[expect]]"));
  const std::string still = folder.write("still.toml", text);
  const std::size_t ratio = text.find('\n', text.find("poissons_ratio")) + 1;
  text.insert(ratio, "density = 1000\n");
  const std::string moving =
      folder.write("moving.toml", text + "[dynamics]\nscheme = \"newmark\"\nstep = 0.01\nend = 0.06\n");
  const auto bodies = [&] {
    std::size_t n = 0;
    for (const auto& entry : fs::recursive_directory_iterator(out))
      n += entry.path().parent_path().filename() == "sheared-cube_motion";
    return n;
  };
  printed_by("run --only msm " + moving + " --out " + out);
  CHECK(bodies() == 7);
  printed_by("run --only msm " + moving + " --set dynamics.write_every=3 --out " + out);
  CHECK(bodies() == 3);
  printed_by("run --only msm " + still + " --out " + out);
  CHECK(bodies() == 0);
  for (const char* name : {"sheared-cube.pvd", "sheared-cube_motion.csv", "sheared-cube_motion"})
    CHECK_FALSE(fs::exists(out + "/" + name));
}

TEST_CASE("cases whose files would have one name do not share a folder") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string(), text = content(gated_cube);
  const auto named = [&](const std::string& file, const std::string& name) {
    std::string other = text;
    const std::string old = "name = \"sheared-cube\"";
    other.replace(other.find(old), old.size(), "name = \"" + name + "\"");
    return folder.write(file, other);
  };
  const std::string small = named("1.toml", "a"), capital = named("2.toml", "A"),
                    springs = named("3.toml", "a_springs");
  check_refused("run " + small + " " + capital + " --out " + out, "another case is named \"A\" too");
  check_refused("run " + springs, "does not end with _springs");
  CHECK_FALSE(fs::exists(out));
}
