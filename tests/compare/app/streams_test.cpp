// Standard output is the results' alone, and nobody else's files decide what the program does.

#include "tests/support/run_program.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace {

const std::string sheared_cube = std::string(SPRINGPROOF_SOURCE_DIR) + "/cases/gates/sheared_cube.toml";

/// The case with texts that terminals and continuous-integration servers would take for commands.
std::string strange_case() {
  std::string text = content(sheared_cube);
  const auto put = [&](const std::string& key, const std::string& value) {
    const std::size_t at = text.find("\n" + key + " = ");
    REQUIRE(at != std::string::npos);
    text.replace(at + 1, text.find('\n', at + 1) - at - 1, key + " = " + value);
  };
  put("name", R"("a##[add-mask]a")"); // a name begins with a letter
  put("description", R"("\u001b[2J\u009b2J\n::add-mask::b ##[add-mask]c")");
  const std::string strange = R"("u\n::add-mask::d\u001b[2J")";
  text.erase(text.find("[[measure]]"));
  return text + "[[measure]]\nname = " + strange + "\nkind = \"volume\"\n[[expect]]\nmeasure = " + strange +
         "\nmsm = [0, 1]\nreference = \"regression\"\nreason = " + strange + "\n";
}

/// A server takes a line for a command that begins with :: behind blanks, or has ##[ anywhere.
void check_harmless(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    CHECK(line.find("::") != std::min(line.find_first_not_of(" \t\r"), line.size()));
  CHECK(text.find("##[") == std::string::npos);
  CHECK(text.find('\x1b') == std::string::npos);
  CHECK(text.find("\xc2\x9b") == std::string::npos);
}

} // namespace

TEST_CASE("texts of a case are printed and written as data, in every format") {
  const TemporaryFolder folder;
  const std::string file = folder.write("case.toml", strange_case()), out = (folder.path / "out").string(),
                    junit = (folder.path / "junit.xml").string(), to_folder = " --out " + out + " " + file;
  const ProgramRun run = run_program("run --only msm" + to_folder);
  CHECK(run.status == 1); // the expectation is missed
  CHECK(run.out.find("add-mask::d") != std::string::npos);
  const ProgramRun again = run_program("run --only msm" + to_folder);
  CHECK(again.error.find("solved already") != std::string::npos);
  const ProgramRun gate =
      run_program("gate --workers 1 --junit " + junit + " --set fem.accuracy=none " + file);
  CHECK(gate.status == 1);
  const ProgramRun json = run_program("run --only msm --json " + file);
  CHECK(nlohmann::json::parse(json.out)["cases"][0]["measures"][0]["name"] == "u\n::add-mask::d\x1b[2J");
  const ProgramRun refused = run_program("run --set 'expect[0].measure=\"::add-mask::e\\u001b\"' " + file);
  CHECK(refused.status == 2);
  for (const std::string& text : {run.out, run.error, again.out, again.error, gate.out, gate.error, json.out,
                                  refused.error, content(out + "/comparison.csv"), content(junit)})
    check_harmless(text);
}

TEST_CASE("a sweep's plan and tables have the texts of a case as data", "[long]") {
  const TemporaryFolder folder;
  std::string text = content(SPRINGPROOF_SOURCE_DIR "/tests/compare/sweep/tiny.toml");
  text.replace(text.find("name = "), text.find('\n', text.find("name = ")) - text.find("name = "),
               R"(name = "a ##[add-mask]a\u009b")");
  const std::string out = (folder.path / "out").string();
  // One cell by the nonlinear method is a mechanism: a failed row, beside which others answer.
  check_harmless(printed_by("sweep --quick --out " + out + " " + folder.write("case.toml", text)));
  for (const char* name : {"plan.txt", "sweep.txt", "sweep.csv", "field_first.gp", "field_first.svg"})
    check_harmless(content(out + "/" + name));
}

TEST_CASE("output that cannot be written is an error of one line, the version and help too") {
  for (const std::string& words : {"run --only msm " + sheared_cube, std::string("--version"),
                                   std::string("--help"), std::string("run --help")})
    for (const char* lost : {" >/dev/full", " >&-"}) {
      INFO(words << lost);
      const ProgramRun run = run_program(words + lost);
      CHECK(run.status == 2);
      CHECK(run.error == "springproof: standard output cannot be written\n");
    }
}

TEST_CASE("what is wrong with a command line is said once, by one rank", "[long]") {
  const std::string ranks =
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n 2 ";
  const ProgramRun wrong = run_program("run", ranks);
  CHECK(wrong.status == 2);
  const std::string said = "case is required";
  const std::size_t first = wrong.error.find(said);
  REQUIRE(first != std::string::npos);
  CHECK(wrong.error.find(said, first + 1) == std::string::npos);
  const ProgramRun version = run_program("--version", ranks);
  CHECK(version.status == 0);
  CHECK(std::count(version.out.begin(), version.out.end(), '\n') == 1);
}

TEST_CASE("what PETSc is asked to print does not get into the results") {
  CHECK(nlohmann::json::accept(
      printed_by("run --only fem --json " + sheared_cube, "PETSC_OPTIONS=-log_view ")));
}

TEST_CASE("options of PETSc that write a file or start a program are refused") {
  const TemporaryFolder folder;
  const std::string view = (folder.path / "view").string();
  for (const std::string& option :
       {"-log_view :" + view, "-msm_ksp_view ascii:" + view, "-options_file " + view,
        std::string("-on_error_attach_debugger"), std::string("-ksp_view binary"),
        std::string("-ksp_converged_reason binary"), "-ksp_" + std::string(100000, 'a'),
        std::string("-dll_append x"), "-log_trace " + view}) {
    check_refused("run --only msm " + sheared_cube, "PETSC_OPTIONS: has ",
                  "cd " + folder.path.string() + " && PETSC_OPTIONS='" + option + "' ");
    CHECK(std::filesystem::is_empty(folder.path));
  }
  printed_by("run --only msm " + sheared_cube,
             "PETSC_OPTIONS='-msm_ksp_rtol 1e-9 -msm_pc_type gamg -ksp_monitor' ");
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

TEST_CASE("a working folder that is gone is no obstacle") {
  const TemporaryFolder folder;
  const std::string gone = (folder.path / "gone").string();
  const ProgramRun run = run_program("run --only msm " + sheared_cube,
                                     "mkdir " + gone + " && cd " + gone + " && rmdir " + gone + " && ");
  CHECK(run.status == 0);
  CHECK(std::count(run.error.begin(), run.error.end(), '\n') <= 1); // Open MPI's
}

// Open MPI would make a folder there that all programs of a user share, and one that ends removes.
TEST_CASE("a program alone makes no folder of MPI's") {
  const ProgramRun run = run_program("run --only msm " + sheared_cube, "TMPDIR=/proc ");
  CHECK(run.status == 0);
  CHECK(run.error.empty());
}
