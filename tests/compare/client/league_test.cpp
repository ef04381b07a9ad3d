#include "compare/client/league.hpp"

#include "cases/case/error.hpp"
#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

using namespace springproof;

namespace {

/// A client that shears the body by its first argument, and says that a step took its second, ms.
const char* const shearing = R"(import json, struct, sys
shear, milliseconds = (float(word) for word in (sys.argv[1:] + ["0", "1"])[:2])
out = sys.stdout.buffer
header = json.loads(sys.stdin.buffer.readline())
raw = {e["name"]: sys.stdin.buffer.read(8 * e["shape"][0] * e["shape"][1]) for e in header["arrays"]}["nodes"]
places = list(struct.unpack("<%dd" % (len(raw) // 8), raw))
for node in range(0, len(places), 3): places[node] += shear * places[node + 2]
def say(line, raw=b""): out.write(json.dumps(line).encode() + b"\n" + raw)
say({"protocol": 1, "name": "shear", "version": "1", "method": "none", "settings": {}, "unsupported": []})
say({"frame": 0, "time": 1, "seconds": milliseconds / 1000, "steps": 1, "at_rest": True, "has": "positions",
     "nodes": len(places) // 3}, struct.pack("<%dd" % len(places), *places))
say({"end": True})
)";

/// A block of 1 mm that is sheared by 0.027 about, and two clients, one of which is not there.
std::string league_in(const TemporaryFolder& folder, const std::string& more = "") {
  std::ofstream(folder.path / "shear.py") << shearing;
  std::ofstream(folder.path / "block.toml")
      << "schema = 1\nname = \"block\"\n[body]\nshape = \"box\"\nsize = [1, 1, 1]\ncells = [2, 2, 2]\n"
         "[material]\nmodel = \"linear_elastic\"\nyoungs_modulus = 0.3\npoissons_ratio = 0.25\n"
         "[[fixed]]\nregion = \"z-\"\n[[load]]\nregion = \"z+\"\nkind = \"traction\"\nvalue = [0.002, 0, 0]\n"
         "[fem]\naccuracy = \"none\"\n[[measure]]\nname = \"top\"\nkind = \"displacement\"\nnode = \"x+ y+ "
         "z+\"\n"
         "component = \"x\"\n";
  const std::string file = (folder.path / "league.toml").string();
  std::ofstream(file) << "cases = [\"block.toml\"]\nmilliseconds_a_step = 5\n"
                      << more
                      << "[[client]]\nname = \"shear\"\ncommand = \"/usr/bin/python3 ./shear.py\"\n"
                         "options = [\"0.5\", \"0.02\", \"0.027 50\"]\n"
                         "[[client]]\nname = \"absent\"\ncommand = \"nothing\"\nneeds = [\"engine\"]\n";
  return file;
}

} // namespace

TEST_CASE("a league has a client's defaults and the nearest of its settings that are fast enough, and skips "
          "who is not there") {
  const TemporaryFolder folder;
  const compare::League league = compare::read_league(league_in(folder));
  std::vector<std::string> told;
  const compare::LeagueTable table =
      compare::play(league, [&](const std::string& what) { told.push_back(what); });
  REQUIRE(table.cases.size() == 1);
  const auto& rows = table.cases[0].rows;
  REQUIRE(rows.size() == 4); // finite elements, springs, and two of the client
  if (rows[2].failure.find("cannot confine a program") != std::string::npos) {
    WARN("nothing was checked: " + rows[2].failure);
    return;
  }
  CHECK(rows[2].chosen == "defaults");
  CHECK(rows[2].worst == Approx(-100)); // it does not move
  CHECK(rows[3].chosen == "best of 4: 0.02");
  CHECK(std::abs(*rows[3].worst) < 60); // 0.027 would be nearer, and takes 50 ms a step
  CHECK(told.size() == 5);
  REQUIRE(table.skipped.size() == 1);
  CHECK(table.skipped[0].name == "absent");

  const auto document = compare::league_to_json(table, league);
  CHECK(document["cases"][0]["rows"].size() == 4);
  CHECK(document["cases"][0]["rows"][3]["chosen"] == rows[3].chosen);
  CHECK(document["skipped"][0]["client"] == "absent");
  std::ostringstream page;
  compare::write_league_markdown(page, table, league);
  CHECK_THAT(page.str(), Catch::Contains("## block") && Catch::Contains("| shear | best of 4: 0.02 |") &&
                             Catch::Contains("absent was skipped"));
}

TEST_CASE("a league's file is refused with the place of what is wrong") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH(compare::read_league(league_in(folder, "seconds = 0\n")),
                    Catch::Contains("league.toml:3:11: seconds: is 0, must be a number above 0"));
  CHECK_THROWS_WITH(compare::read_league(league_in(folder, "secnds = 3\n")), Catch::Contains("secnds"));
  CHECK_THROWS_WITH(compare::read_league((folder.path / "none.toml").string()), Catch::Contains("none.toml"));
}

TEST_CASE("a league has a method of ours beside its clients, and says what it ignores") {
  const TemporaryFolder folder;
  league_in(folder);
  const auto league_of = [&](const std::string& keys) {
    const std::string file = (folder.path / "league.toml").string();
    std::ofstream(file) << "cases = [\"block.toml\"]\n[[client]]\nname = \"ours\"\n" << keys;
    return compare::read_league(file);
  };
  CHECK_THROWS_WITH(league_of("method = \"xpbd\"\ncommand = \"mine\"\n"),
                    Catch::Contains("client[0].command"));
  CHECK_THROWS_WITH(league_of("command = \"mine\"\nsubsteps = [1]\n"), Catch::Contains("client[0].substeps"));
  const compare::League league =
      league_of("method = \"vertex_block_descent\"\niterations = [1, 40]\nsubsteps = [0, 2]\n");
  const auto rows = [&] { return compare::play(league, [](const std::string&) {}).cases.at(0).rows; };
  CHECK_THAT(rows().at(2).failure, Catch::Contains("material.density"));

  std::ofstream(folder.path / "block.toml", std::ios::app)
      << "[dynamics]\nscheme = \"newmark\"\nstep = 0.001\nend = 0.005\n[msm]\nmass = \"consistent\"\n";
  std::ostringstream text;
  text << std::ifstream(folder.path / "block.toml").rdbuf();
  const std::string ratio = "poissons_ratio = 0.25\n";
  std::string moving = text.str();
  moving.replace(moving.find(ratio), ratio.size(), ratio + "density = 1000\n");
  moving.replace(moving.find("accuracy = \"none\""), 17, "");
  std::ofstream(folder.path / "block.toml") << moving;
  const auto stepped = rows();
  REQUIRE(stepped.size() == 4); // finite elements, springs, and two of the method
  for (const std::size_t row : {2, 3}) {
    CHECK(stepped[row].status() == "answered");
    CHECK(stepped[row].model == "ours");
    REQUIRE(stepped[row].client);
    CHECK(stepped[row].client->unsupported ==
          std::vector<std::string>{"masses that are not lumped", "scheme newmark"});
    CHECK(stepped[row].milliseconds_a_step);
  }
  CHECK_THAT(stepped[3].chosen, Catch::StartsWith("best of 5: "));
  CHECK(std::abs(*stepped[3].worst) <= std::abs(*stepped[2].worst));
}

TEST_CASE("the parts of an error in a league add up to it") {
  const TemporaryFolder folder;
  std::ofstream(folder.path / "bar.toml")
      << "schema = 1\nname = \"bar\"\n[body]\nshape = \"box\"\nsize = [20, 10, 10]\ncells = [2, 1, 1]\n"
         "[material]\nmodel = \"linear_elastic\"\nyoungs_modulus = 0.1\npoissons_ratio = 0.25\n"
         "density = 1000\n[[fixed]]\nregion = \"x-\"\n[[load]]\nkind = \"gravity\"\nvalue = [0, 0, "
         "-9.81]\n[msm]\ndesign = \"moduli\"\n[[measure]]\nname = \"tip\"\nkind = \"displacement\"\n"
         "node = \"x+ y- z-\"\ncomponent = \"z\"\n";
  const std::string file = (folder.path / "league.toml").string();
  std::ofstream(file) << "cases = [\"bar.toml\"]\n[[client]]\nname = \"few\"\nmethod = \"xpbd\"\n"
                         "substeps = [1]\niterations = [4]\n[[client]]\nname = \"many\"\n"
                         "method = \"implicit_euler\"\n[[client]]\nname = \"elements\"\n"
                         "method = \"fem.corotational\"\n";
  const compare::League league = compare::read_league(file);
  const compare::LeagueTable table = compare::play(league, [](const std::string&) {});
  int n_judged = 0, n_of_elements = 0;
  for (const compare::JudgedRow& row : table.cases.at(0).rows) {
    CAPTURE(row.model, row.chosen, row.failure);
    if (!row.worst) continue;
    ++n_judged;
    REQUIRE(row.parts);
    REQUIRE(row.parts->sum());
    CHECK(std::abs(*row.parts->sum() - *row.worst) <= 0.1 * std::abs(*row.worst));
    CHECK(row.parts->step.percent == 0.); // a body at rest has none
    if (row.model == "many" || row.model == compare::springs_model)
      CHECK(std::abs(row.parts->iterations.percent.value()) < 1);
    if (row.model == "elements") {
      ++n_of_elements;
      const compare::JudgedRow& solved = table.cases.at(0).rows.front(); // by another law, on the same mesh
      CHECK(row.parts->mesh.percent.value() == Approx(*solved.worst).epsilon(1e-3));
      CHECK(row.parts->law.percent.value() != 0.);
      CHECK(std::abs(row.parts->iterations.percent.value()) < 1);
    }
    if (row.model == "few") CHECK(std::abs(row.parts->iterations.percent.value()) > 10);
  }
  CHECK(n_judged >= 5);
  CHECK(n_of_elements >= 1);
  std::ostringstream page;
  compare::write_league_markdown(page, table, league);
  CHECK_THAT(page.str(), Catch::Contains("| law, % | mesh, % | step, % | iterations, % |"));
}
