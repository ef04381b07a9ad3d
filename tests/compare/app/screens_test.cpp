// What commands print, as their users see it: lines of a screen, the same options, the exit status.

#include "tests/support/run_program.hpp"
#include "tests/support/screen.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

namespace fs = std::filesystem;
using Catch::Contains;
using Json = nlohmann::json;

namespace {

const std::string source_folder = SPRINGPROOF_SOURCE_DIR;
const std::string tiny = source_folder + "/tests/compare/sweep/tiny.toml";
constexpr std::size_t screen = 100; ///< characters

} // namespace

TEST_CASE("the tables' audit leaves the text for files of --out, which the text names", "[long]") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  const std::string text = printed_by("tables 4.1 --out " + out, in_source);
  CHECK(width_of_text(text.substr(0, text.find("Audit"))) <= screen);
  for (const char* file : {"audit.txt", "tables.csv", "tables.json", "report.html"}) {
    CHECK_THAT(text, Contains(file));
    CHECK(fs::file_size(fs::path(out) / file) > 100);
  }
  const std::string audit = content(out + "/audit.txt");
  CHECK_THAT(audit, Contains("build/springproof design --young") && Contains("by the declared reference"));
  CHECK(audit == printed_by("tables 4.1 --trace", in_source));
  CHECK(text.rfind(content(out + "/tables.txt"), 0) == 0);
}

TEST_CASE("a comparison of designs ends with the one to use", "[long]") {
  const std::string words = "design --young 0.3 --poisson 0.35 --compare --measure";
  const std::string text = printed_by(words);
  CHECK(width_of_text(text) <= screen);
  const std::vector<std::string> lines = lines_of_text(text);
  const auto last = std::find(lines.rbegin(), lines.rend(), "");
  REQUIRE(last != lines.rend());
  const std::string words_of_end = *last.base();
  const Json document = document_of(words + " --json");
  const std::string recommended = document["recommended"];
  CHECK(words_of_end.rfind("Use " + recommended + " for E = 0.3 MPa and nu = 0.35: its worst error", 0) == 0);
  double least = 1e9; // percent
  std::string best;
  for (const Json& method : document["methods"])
    if (method.contains("cube") && method["cube"]["stable"] &&
        method["cube"]["worst_error_percent"] < least) {
      least = method["cube"]["worst_error_percent"];
      best = method["method"];
    }
  CHECK(recommended == best);
}

TEST_CASE("a comparison that is not measured tells how to find the one to use") {
  const std::string text = printed_by("design --young 0.3 --poisson 0.45 --compare");
  CHECK(width_of_text(text) <= screen);
  CHECK_THAT(text, Contains("--measure"));
}

TEST_CASE("--set changes a key of the case in sweep, gate, eigen and design, and a wrong one is told as run "
          "tells it") {
  const std::string cube = "cases/gates/sheared_cube.toml";
  const std::string eigen = "eigen --case " + cube;
  CHECK(printed_by(eigen, in_source) != printed_by(eigen + " --set material.poissons_ratio=0.2", in_source));
  const Json designed =
      document_of("design --case " + cube + " --set material.poissons_ratio=0.2 --json", in_source);
  CHECK(designed["settings"] == Json{"material.poissons_ratio=0.2"});
  const std::string wrong = " --set material.poisson=0.2";
  const ProgramRun run = run_program("run " + cube + wrong, in_source);
  REQUIRE(run.status == 2);
  for (const std::string& command :
       {"gate " + cube, "sweep " + cube, eigen, "eigen " + cube, "design --case " + cube})
    CHECK(run_program(command + wrong, in_source).error == run.error);
  CHECK(run_program("eigen --poisson 0.3 --set material.poissons_ratio=0.2").status == 2);
}

TEST_CASE("a sweep with --set has it in its text and its JSON, and answers another question", "[long]") {
  const TemporaryFolder folder;
  const std::string one = (folder.path / "one").string(), other = (folder.path / "other").string();
  const std::string words = "sweep --quick --budget 1e-3 " + tiny; // the reference's meshes alone
  const std::string setting = "material.poissons_ratio=0.3";
  const std::string text = printed_by(words + " --set " + setting + " --out " + one);
  CHECK_THAT(text, Contains("with " + setting));
  CHECK(lines_of_text(text).size() <= 45);
  CHECK(width_of_text(text.substr(0, text.find("the sweep took"))) <= screen);
  printed_by(words + " --out " + other);
  const Json with = Json::parse(content(one + "/sweep.json")),
             without = Json::parse(content(other + "/sweep.json"));
  CHECK(with["settings"] == Json{setting});
  CHECK(without["settings"] == Json::array());
  CHECK(with["reference"]["field"]["value"] != without["reference"]["field"]["value"]);
}

TEST_CASE("designs that are refused among others leave the status of what was answered", "[long]") {
  // The multi-load method designs for cubes alone.
  const std::string words = "eigen " + source_folder +
                            "/cases/studies/released_bar.toml --modes 2 --set body.cells=[1,1,4] --designs ";
  const std::string both = printed_by(words + "multi_load,moduli");
  CHECK_THAT(both, Contains("multi_load: ") && Contains("moduli\n"));
  CHECK(width_of_text(both) <= screen);
  CHECK(run_program(words + "multi_load").status == 1); // all that was asked for is refused
  CHECK(run_program("design --young 0.3 --poisson -0.2 --compare").status == 0);
  CHECK(run_program("design --young 0.3 --poisson -0.2 --method hybrid").status == 2);
}

TEST_CASE("what eigen, export and stress print stands in 100 characters") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  for (const std::string& words :
       {std::string("eigen --poisson 0.3 --body 2"),
        std::string("eigen --young 1 --poisson 0 --method moduli"),
        std::string("stress mechanism disconnected_piece"),
        "export cases/gates/sheared_cube.toml --to sofa --set msm.design=moduli --out " + out}) {
    const std::string text = printed_by(words, in_source);
    INFO(text);
    CHECK(width_of_text(text) <= screen);
    CHECK_FALSE(has_shouting(text, {"SOFA"}));
  }
}
