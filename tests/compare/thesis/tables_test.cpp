// `springproof tables` as its users run it.

#include "tests/support/run_program.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

/// Standard output of the program in the project's folder; the exit status must be 0.
/// @param words  arguments as typed in a shell
std::string output(const std::string& words) {
  const ProgramRun run = run_program(words, "cd " SPRINGPROOF_SOURCE_DIR " && ");
  INFO(run.error);
  REQUIRE(run.status == 0);
  return run.out;
}

/// The words behind the program's name in a command that a result carries.
std::string words_of(const Json& entry) {
  const std::string command = entry["command"], program = "build/springproof ";
  REQUIRE(command.rfind(program, 0) == 0);
  return command.substr(program.size());
}

} // namespace

// The bar and the cells: the cheapest tables, yet both kinds of model and the pool are in them.
TEST_CASE("the same tables come out byte for byte, on one worker and on three", "[long]") {
  const TemporaryFolder folder;
  // Names of one length: the text is folded where its lines are full.
  const fs::path one = folder.path / "workers_1", three = folder.path / "workers_3";
  const auto without = [](std::string text, const std::string& name) { // the folder, which the text names
    const std::size_t at = text.find(name);
    REQUIRE(at != std::string::npos);
    return text.erase(at, name.size());
  };
  CHECK(without(output("tables 4.1 4.3 5.12 --workers 1 --out " + one.string()), one.string()) ==
        without(output("tables 4.1 4.3 5.12 --workers 3 --out " + three.string()), three.string()));
  int n_files = 0, n_drawn = 0;
  for (const auto& file : fs::recursive_directory_iterator(one)) {
    if (file.is_directory() || file.path().filename() == "report.html")
      continue; // the report tells the times
    CAPTURE(file.path());
    const fs::path inside = fs::relative(file.path(), one);
    CHECK(content(file.path()) == content(three / inside));
    ++(inside.has_parent_path() ? n_drawn : n_files);
  }
  CHECK(n_files ==
        6 + 3); // tables as text, CSV, JSON, their audit; volumes and box plots; a .vtu for each bar
  CHECK(n_drawn > 0);
  CHECK(fs::file_size(one / "report.html") > 100'000);
}

TEST_CASE("tables --json has the promised keys, and each command gives its number again", "[long]") {
  const Json document = Json::parse(output("tables 4.2 4.3 5.12 --json"));
  CHECK(document["schema"] == 1);
  const Json& entries = document["entries"];
  REQUIRE(entries.size() == 2 * (6 + 9) + 11 + 3);
  for (const Json& entry : entries)
    for (const char* key :
         {"table", "material", "poissons_ratio", "design", "design_poissons_ratio", "load_set", "test",
          "measure", "unit", "published", "computed", "reference", "other", "case", "settings", "command"})
      CHECK(entry.contains(key));
  const Json& bar = entries.back(); // 4x4x16 cells
  REQUIRE(bar["table"] == "5.12");
  CHECK(std::abs(bar["computed"].get<double>() - bar["published"].get<double>()) <=
        0.1); // what is known of it
  const Json again = Json::parse(output(words_of(bar) + " --json"));
  CHECK(again["cases"][0]["measures"][0]["error_percent"] == bar["computed"]);
  const Json& h = entries[2 * (6 + 9) + 7]; // nu = 0.35
  CHECK(Json::parse(output(words_of(h) + " --json"))["h"] == h["computed"]);
  CHECK(document["summary"]["groups"].size() == 2);
}

TEST_CASE("a stiffness of table 4.1 comes out of its command in N/m") {
  const Json entry = Json::parse(output("tables 4.1 --json"))["entries"][7];
  const Json design = Json::parse(output(words_of(entry) + " --json"));
  CHECK(design["stiffness_N_per_m"][0].get<double>() ==
        Approx(entry["computed"].get<double>()).epsilon(1e-9)); // least squares at another E
}

namespace {

Json group(const Json& document, const std::string& name) {
  for (const Json& candidate : document["summary"]["groups"])
    if (candidate["name"] == name) return candidate;
  FAIL("no group " << name);
  return Json();
}

int n_beyond(const Json& of_group, double bound) {
  for (const Json& within : of_group["within"])
    if (within["bound"] == bound) return within["neither"].get<int>();
  FAIL("no bound " << bound);
  return 0;
}

} // namespace

// The bounds are those that an independent computation of the thesis's cases reaches.
TEST_CASE("all volumes in print are met within 2 mm3, the bar within 1.6 points", "[verification][long]") {
  const Json document = Json::parse(output("tables 5.2 5.12 --json"));
  CHECK(group(document, "volumes (5.2)")["entries"] == 6);
  CHECK(n_beyond(group(document, "volumes (5.2)"), 2) == 0);
  CHECK(group(document, "bar (5.12)")["entries"] == 3);
  CHECK(n_beyond(group(document, "bar (5.12)"), 1.6) == 0);
}

// A pin of our own count, not a proof: print itself is wrong in some of these.
TEST_CASE("of the 90 errors in print, beta_1 aside, no more are missed by a point than were",
          "[regression][long]") {
  const Json document = Json::parse(output("tables 4.5 4.6 4.7 5.1 5.3 5.4 --json"));
  CHECK(group(document, "errors, beta_1 aside")["entries"] == 90);
  CHECK(n_beyond(group(document, "errors, beta_1 aside"), 1) <= 15);
  for (const Json& entry : document["entries"]) CHECK(entry["computed"].is_number());
}
