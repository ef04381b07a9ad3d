// What `run` prints, as its readers have it before them: a screen, the verdict last, no alarm without a
// reason.

#include "tests/support/run_program.hpp"
#include "tests/support/screen.hpp"
#include "tests/support/unwrapped.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>
#include <vector>

namespace {

const std::string source = SPRINGPROOF_SOURCE_DIR;

/// The words in capitals of five letters and more.
std::vector<std::string> shouts_in(const std::string& text) {
  const std::regex capitals("\\b[A-Z]{5,}\\b");
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), capitals); at != std::sregex_iterator(); ++at)
    found.push_back(at->str());
  return found;
}

/// Commands are as long as what was typed.
void check_width(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    CAPTURE(line);
    CHECK((line.size() <= 100 || line.rfind("  " SPRINGPROOF_PROGRAM, 0) == 0)); // these texts are ASCII
  }
}

void check_is_a_screen(const std::string& text) {
  const std::vector<std::string> lines = lines_of_text(text);
  CHECK(lines.size() <= 25);
  check_width(lines);
  CHECK(shouts_in(text).empty());
}

std::size_t line_that_begins(const std::vector<std::string>& lines, const std::string& beginning) {
  const auto found = std::find_if(lines.begin(), lines.end(),
                                  [&](const std::string& line) { return line.rfind(beginning, 0) == 0; });
  REQUIRE(found != lines.end());
  return static_cast<std::size_t>(found - lines.begin());
}

/// The commands that a text ends with, without their comments.
std::vector<std::string> commands_at_the_end(const std::string& text) {
  std::vector<std::string> commands;
  const std::vector<std::string> lines = lines_of_text(text);
  for (std::size_t n = line_that_begins(lines, "What to type next:") + 1; n < lines.size(); ++n)
    if (const std::string command = lines[n].substr(0, lines[n].find("   #")); command.rfind("  # ", 0) != 0)
      commands.push_back(command.substr(2));
  return commands;
}

/// @param truth  reference of the errors that the verdict names
void check_static_case(const std::string& file, const std::string& truth) {
  CAPTURE(file);
  const std::string text = printed_by("run " + file, in_source);
  CAPTURE(text);
  check_is_a_screen(text);
  CHECK_THAT(unwrapped(text), Catch::Contains("Verdict: The springs are up to ") && Catch::Contains(truth) &&
                                  Catch::Contains(" times as fast. "));
  const std::vector<std::string> lines = lines_of_text(text);
  const std::size_t verdict = line_that_begins(lines, "Verdict: "),
                    next = line_that_begins(lines, "What to type");
  CHECK(line_that_begins(lines, "  measure") < verdict);
  CHECK(verdict < next);
  CHECK(next + 7 >= lines.size());
  CHECK_THAT(text, Catch::Contains(" run " + file + " --designs all"));
}

const std::string from_the_limit =
    "from the truth, the limit of the finite elements, which themselves err by up to ";

} // namespace

TEST_CASE("a static case of two measures is a screen, with its verdict and what to type next at its end") {
  check_static_case("cases/gates/sheared_cube.toml",
                    "from the finite elements on the same mesh, whose own error on this mesh is not known");
  check_static_case("cases/gates/sheared_block.toml", from_the_limit);
}

TEST_CASE("a study is a screen too", "[long]") {
  check_static_case("cases/studies/liver_press/case.toml", from_the_limit);
}

TEST_CASE("the verdict has the numbers of the JSON", "[long]") {
  const std::string file = "cases/gates/sheared_block.toml";
  const auto measures = document_of("run --json " + file, in_source)["cases"][0]["measures"];
  double worst = 0, bar = 0, own = 0;
  for (const auto& m : measures) {
    own = std::max(own, std::abs(m["fem_error_percent"].get<double>()));
    if (std::abs(m["error_percent"].get<double>()) < worst) continue;
    worst = std::abs(m["error_percent"].get<double>());
    bar = m["error_uncertainty_percent"].get<double>();
  }
  const std::string text = unwrapped(run_program("run " + file, in_source).out);
  std::smatch found;
  REQUIRE(std::regex_search(
      text, found,
      std::regex("The springs are up to ([0-9.]+) \\+- ([0-9.]+) % .* themselves err by up to "
                 "([0-9.]+) \\+- [0-9.]+ % on this mesh\\.")));
  CHECK(std::stod(found[1]) == Approx(worst).margin(0.005)); // rounded as printed
  CHECK(std::stod(found[2]) == Approx(bar).epsilon(0.05));
  CHECK(std::stod(found[3]) == Approx(own).margin(0.005));
}

TEST_CASE("what is to be typed next is a command that works, with the settings that were typed", "[long]") {
  const TemporaryFolder folder;
  const std::string text = content(source + "/cases/gates/sheared_block.toml");
  const std::string file = folder.write("it's a case.toml", text.substr(0, text.find("[[expect]]")));
  const std::string here = "cd '" + folder.path.string() + "' && ";
  const std::string words = "run \"it's a case.toml\" --set fem.accuracy=none";
  const std::vector<std::string> commands = commands_at_the_end(printed_by(words, here));
  REQUIRE(commands.size() == 3);
  for (const std::string& command : commands) {
    CAPTURE(command);
    const std::string program = SPRINGPROOF_PROGRAM;
    REQUIRE(command.rfind(program + " run 'it'\\''s a case.toml' --set fem.accuracy=none", 0) == 0);
    CHECK(run_program(command.substr(program.size()), here).status == 0);
  }
  for (const std::string& line : lines_of_text(printed_by(words + " --designs all", here)))
    if (const std::size_t at = line.find("--set 'msm="); at != std::string::npos)
      CHECK(run_program(line.substr(std::string("  ").size() + std::string(SPRINGPROOF_PROGRAM).size()), here)
                .status == 0);
}

TEST_CASE("a motion's text says whether a step keeps up with a screen") {
  const std::string printed = printed_by(
      "run tests/compare/interact/pulled_block.toml --set dynamics.end=0.1 --set dynamics.step=0.01",
      in_source);
  CAPTURE(printed);
  CHECK(std::regex_search(
      unwrapped(printed),
      std::regex("Time: the springs [0-9.e+]+ ms a step: (keeps|does not keep) 60 Hz; the finite elements "
                 "[0-9.e+]+ ms a step: (keeps|does not keep) 60 Hz\\.")));
  check_width(lines_of_text(printed));
}

TEST_CASE("springs that fail leave the reason, and the command that looks for others") {
  const ProgramRun run = run_program("run cases/gates/sheared_cube.toml --set msm.design=baudet", in_source);
  CHECK(run.status == 1);
  CHECK_THAT(
      unwrapped(run.out),
      Catch::Contains("failed at 0.7") &&
          Catch::Contains(
              "Verdict: There is nothing to compare: mass-spring equilibrium: no equilibrium was found "
              "beyond this load. 4 of 6 expectations are not met. ") &&
          Catch::Contains("# designs that may hold here"));
}

TEST_CASE("run --converge has the table of its meshes in 100 columns, and --out says which files there are",
          "[long]") {
  const TemporaryFolder folder;
  const std::string out = (folder.path / "out").string();
  const std::string text =
      printed_by("run --converge=4 cases/gates/sheared_block.toml --out " + out, in_source);
  check_width(lines_of_text(text));
  CHECK_THAT(text, Catch::Contains("fem on refined meshes") && Catch::Contains("GCI %"));
  CHECK_THAT(unwrapped(text), Catch::Contains(out + "/results.json, comparison.csv, sheared-block.vtu"));
}

TEST_CASE("every design of a case is a table of 100 columns, and the advice comes last") {
  const std::string text = printed_by("run cases/gates/sheared_cube.toml --designs all", in_source);
  CAPTURE(text);
  const std::vector<std::string> lines = lines_of_text(text);
  check_width(lines);
  CHECK(shouts_in(text).empty());
  CHECK(line_that_begins(lines, "    design") < line_that_begins(lines, "Use "));
}
