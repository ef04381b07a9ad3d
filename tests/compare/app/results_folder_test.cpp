// The folder of --out as users meet it: what is taken up again, what is refused, what is solved anew.

#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

namespace fs = std::filesystem;

namespace {

const std::string cube = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/gates/sheared_cube.toml";

/// The case without what it expects, which another modulus would miss.
std::string cube_without_expectations() {
  const std::string text = content(cube);
  return text.substr(0, text.find("[[expect]]"));
}

/// A folder with a case of the name "sheared-cube", and one of results.
struct Workplace {
  TemporaryFolder folder;
  std::string file = folder.write("cube.toml", cube_without_expectations());
  std::string out = (folder.path / "out").string();
  ProgramRun run(const std::string& words, const std::string& before = "") const {
    return run_program("run --only msm --out " + out + " " + words, before);
  }
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

bool is_taken_up(const ProgramRun& run) {
  REQUIRE(run.status == 0);
  return run.error.find("solved already") != std::string::npos;
}

std::string with_modulus(const std::string& text, const std::string& modulus) {
  return replaced(text, "youngs_modulus = ", "youngs_modulus = " + modulus + " # ");
}

} // namespace

TEST_CASE("a case is taken up as it was parsed: its text through a pipe, a comment, another place") {
  const Workplace workplace;
  const std::string soft =
      workplace.folder.write("soft.toml", with_modulus(cube_without_expectations(), "0.1"));
  const ProgramRun first = workplace.run("/dev/stdin", "cat " + workplace.file + " | ");
  CHECK_FALSE(is_taken_up(first));
  CHECK(is_taken_up(workplace.run("/dev/stdin", "cat " + workplace.file + " | ")));
  workplace.folder.write("cube.toml", "# a comment\n" + cube_without_expectations());
  CHECK(is_taken_up(workplace.run(workplace.file)));
  const ProgramRun other = workplace.run("/dev/stdin", "cat " + soft + " | ");
  CHECK_FALSE(is_taken_up(other));
  CHECK(other.out != first.out);
}

TEST_CASE("a geometry whose included file has changed is solved again") {
  const Workplace workplace;
  const std::string templates = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/templates/mesh";
  const std::string geometry = content(templates + ".geo"), height = "{0, 0, 12}";
  workplace.folder.write("TEMPLATE.geo",
                         "Include \"height.geo\";\n" + replaced(geometry, height, "{0, 0, height}"));
  const std::string file = workplace.folder.write(
      "wedge.toml", replaced(content(templates + ".toml"), "near 10 10 12", "near 10 10 0"));
  workplace.folder.write("height.geo", "height = 12;\n");
  CHECK_FALSE(is_taken_up(workplace.run(file)));
  CHECK(is_taken_up(workplace.run(file)));
  workplace.folder.write("height.geo", "height = 6;\n");
  CHECK_FALSE(is_taken_up(workplace.run(file)));
}

TEST_CASE("a kept result that is damaged is solved again, with one line that says so") {
  const Workplace workplace;
  const ProgramRun first = workplace.run(workplace.file);
  const std::string kept = workplace.out + "/solved/sheared-cube", whole = content(kept);
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 4;
  for (const std::string& damaged : {flipped, whole.substr(0, 1000), std::string()}) {
    std::ofstream(kept, std::ios::binary) << damaged;
    const ProgramRun again = workplace.run(workplace.file);
    CHECK_FALSE(is_taken_up(again));
    CHECK(again.out.substr(0, again.out.find(" s")) == first.out.substr(0, first.out.find(" s")));
    CHECK(again.error.find(kept) == 0);
    CHECK(std::count(again.error.begin(), again.error.end(), '\n') == 1);
    CHECK(is_taken_up(workplace.run(workplace.file)));
  }
}

TEST_CASE("two cases of one name are refused for one folder before anything is solved") {
  const Workplace workplace;
  const std::string twin =
      workplace.folder.write("twin.toml", with_modulus(cube_without_expectations(), "0.1"));
  for (const char* command : {"run ", "gate "}) {
    check_refused(command + workplace.file + " " + twin + " --out " + workplace.out, "twin.toml");
    CHECK_FALSE(fs::exists(workplace.out));
  }
  CHECK(run_program("run --only msm " + workplace.file + " " + twin).status == 0);
}

TEST_CASE("a folder that cannot be written is refused before anything is solved") {
  const Workplace workplace;
  const std::string below = workplace.folder.write("file", "in the way") + "/below";
  for (const std::string& words :
       {"run " + workplace.file, "gate " + workplace.file, std::string("stress one_step"),
        std::string("tables 4.1"),
        "sweep --quick " + std::string(SPRINGPROOF_SOURCE_DIR) + "/tests/compare/sweep/tiny.toml",
        std::string("eigen --poisson 0.3"),
        std::string("design --young 1 --poisson 0.3 --edge 1 --method hybrid")})
    check_refused(words + " --out " + below, below);
}

TEST_CASE("what stands in the way of results is found before anything is solved") {
  const Workplace workplace;
  fs::create_directory(workplace.out);
  const std::string solved = workplace.out + "/solved", in_the_way = workplace.folder.write("file", "");
  const std::string regression = workplace.folder.write(
      "regression.toml", cube_without_expectations() +
                             "[[expect]]\nmeasure = \"alpha_1\"\nmsm = [0, 1]\nreference = \"regression\"\n"
                             "reason = \"a test\"\n");
  const auto check_both_refused = [&] {
    check_refused("run " + workplace.file + " --out " + workplace.out, "");
    check_refused("gate " + workplace.file + " --out " + workplace.out, "");
  };
  fs::create_symlink(in_the_way, solved);
  check_both_refused();
  fs::remove(solved);
  for (const char* name :
       {"/results.json", "/sheared-cube.vtu", "/solved/sheared-cube"}) { // folders, not files
    INFO(name);
    fs::create_directories(workplace.out + name);
    check_both_refused();
    fs::remove(workplace.out + name);
  }
  check_refused("gate " + workplace.file + " --junit " + workplace.folder.path.string(), "");
  check_refused("gate " + workplace.file + " --junit " + in_the_way + "/junit.xml", "");
  fs::create_directory(regression + ".springproof-part"); // stands for a folder that takes no new file
  workplace.folder.write("regression.toml.springproof-part/file", "");
  check_refused("gate --bless sheared-cube " + regression, "");
}

TEST_CASE("a disk that is full is found before anything is solved") {
  const Workplace workplace;
  // A limit on the size of files is what a test can set anywhere; the signal that comes with it is ignored.
  check_refused("run --only msm --out " + workplace.out + " " + workplace.file,
                "cannot write '" + workplace.out + "': File too large",
                "trap '' XFSZ; prlimit --fsize=1000 ");
  CHECK(fs::is_empty(workplace.out));
  CHECK(workplace.run(workplace.file).status == 0);
}

TEST_CASE("a picture that could not be written whole is an error, and none is left") {
  const Workplace workplace;
  const ProgramRun cut =
      run_program("design --neo-hookean 0.04 --method nonlinear_method --out " + workplace.out,
                  "trap '' XFSZ; prlimit --fsize=80000 ");
  CHECK(cut.status == 2);
  CHECK_THAT(cut.error, Catch::Contains("cannot write '" + workplace.out + "/figure_5_5.png'"));
  for (const auto& entry : fs::directory_iterator(workplace.out)) {
    INFO(entry.path());
    CHECK(entry.path().extension() != ".springproof-part");
    if (entry.path().extension() == ".png")
      CHECK_THAT(content(entry.path()), Catch::EndsWith("IEND\xae\x42\x60\x82"));
    if (entry.path().extension() == ".svg") CHECK_THAT(content(entry.path()), Catch::EndsWith("</svg>\n\n"));
  }
}

TEST_CASE("two programs do not write into one folder at the same time") {
  const Workplace workplace;
  fs::create_directories(workplace.out);
  check_refused("run --only msm --out " + workplace.out + " " + workplace.file, "another springproof",
                "flock " + workplace.out + " ");
  CHECK(workplace.run(workplace.file).status == 0);
}

TEST_CASE("what is no UTF-8, and names too long for a file, are refused before anything is solved") {
  const Workplace workplace;
  const std::string strange = workplace.folder.write("cube\xff.toml", cube_without_expectations());
  const std::string long_name(300, 'x'), no_file = workplace.folder.path.string() + "/folder.csv";
  fs::create_directory(no_file);
  for (const std::string& words :
       {"run --json --set \"name=$(printf '\\377')\" " + workplace.file, "run --json " + strange,
        "run --set name=" + long_name + " --out " + workplace.out + " " + workplace.file, "new " + long_name,
        "run --msm-displacements " + no_file + " " + workplace.file})
    check_refused(words, "");
}

TEST_CASE("verdicts go to the file that a link leads to") {
  const Workplace workplace;
  const std::string file = workplace.folder.write("gates.xml", ""),
                    link = (workplace.folder.path / "link").string();
  fs::create_symlink(file, link);
  CHECK(run_program("gate --junit " + link + " " + cube).status == 0);
  CHECK(content(file).find("<testsuite") != std::string::npos);
  CHECK(fs::is_symlink(link));
}
