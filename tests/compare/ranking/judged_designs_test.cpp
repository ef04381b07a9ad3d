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
  const ProgramRun of_fem = expecting("fem=[0.2, 0.3]", "hybrid"); // of no springs
  CHECK(of_fem.status == 1);
  CHECK(verdict(of_fem)["judged"] == true);
}
