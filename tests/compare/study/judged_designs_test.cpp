#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

// run --designs did not judge what its case expects, and ended with status 0. Looked for the same kind: run,
// gate, run --report --designs and --only, which judge; tables, sweep and stress have expectations of their
// own.
TEST_CASE(
    "run --designs judges what the case expects by the case's own design, and ends with status 1 where it "
    "is missed") {
  const auto expecting = [](const std::string& interval, const std::string& designs) {
    return run_program("run " SPRINGPROOF_SOURCE_DIR "/examples/library/block.toml --json --designs " +
                       designs + " --set 'expect=[{measure=\"top\", " + interval +
                       ", reference=\"regression\", reason=\"a test\"}]'");
  };
  const auto verdict = [](const ProgramRun& outcome) {
    return nlohmann::json::parse(outcome.out)["cases"][0]["expectations"][0];
  };
  const ProgramRun met = expecting("msm=[0.1, 0.2]", "moduli,hybrid"); // 0.157 mm
  CHECK(met.status == 0);
  CHECK(verdict(met)["met"] == true);
  const ProgramRun missed = expecting("msm=[0.2, 0.3]", "hybrid,moduli");
  CHECK(missed.status == 1);
  CHECK(verdict(missed)["judged"] == true);
  CHECK(verdict(missed)["met"] == false);
  const ProgramRun of_other = expecting("msm=[0.2, 0.3]", "hybrid"); // the case's own is moduli
  CHECK(of_other.status == 0);
  CHECK(verdict(of_other)["judged"] == false);
  const ProgramRun of_fem = expecting("fem=[0.2, 0.3]", "hybrid"); // needs no springs
  CHECK(of_fem.status == 1);
  CHECK(verdict(of_fem)["judged"] == true);
}

TEST_CASE("run --designs --out leaves its ranking as text, CSV and JSON, and prints the same text") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  const ProgramRun run = run_program(
      "run " SPRINGPROOF_SOURCE_DIR "/examples/library/block.toml --designs moduli,hybrid,transverse --out " +
      out);
  CHECK(run.status == 0); // transverse is refused: the material is isotropic
  CHECK_THAT(run.out, Catch::Contains("transverse refused: "));
  CHECK_THAT(run.out, Catch::StartsWith(content(folder.path / "out/ranking.txt")));
  CHECK_THAT(content(folder.path / "out/ranking.csv"), Catch::Contains("block,hybrid,"));
  const auto document = nlohmann::json::parse(content(folder.path / "out/ranking.json"));
  CHECK(document["cases"][0]["designs"].size() == 3);
}

// The status was that of the recommendation: 0 where the case's own springs had failed, and another design
// had not.
TEST_CASE("run --designs ends with status 1 where the case's own springs fail, and tells the others") {
  const std::string words = "run " SPRINGPROOF_SOURCE_DIR "/examples/library/block.toml --json"
                            " --set msm.design=given --set msm.stiffness=[0,0,10]";
  const ProgramRun own = run_program(words + " --designs given,hybrid");
  CHECK(own.status == 1);
  const auto designs = nlohmann::json::parse(own.out)["cases"][0]["designs"];
  CHECK(designs[0]["design"] == "hybrid");
  CHECK(designs[0]["worst_error_percent"].is_number());
  CHECK(designs[1]["design"] == "given");
  CHECK(run_program(words + " --designs hybrid").status == 0);
}
