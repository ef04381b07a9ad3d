#include "compare/gates/bless.hpp"

#include "cases/case/read_case.hpp"
#include "tests/compare/gates/judged.hpp"
#include "tests/support/case_text.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using cases::Quantity;
using cases::ReferenceKind;

namespace {

/// A case file as people write them: comments, tabs, characters of several bytes, an interval on several
/// lines.
const char* const text = R"(schema = 1
name = "block"
[body]
shape = "box"
size = [1, 1, 1]
cells = [1, 1, 1]
[material]
model = "linear_elastic"
youngs_modulus = 1
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "nodal_force"
value = [0, 0, 0.01]
[[measure]]
name = "L"
kind = "coordinate"
node = "z+ x+ y+"
axis = "z"

[[expect]]
measure = "L"
	fem =   [ 0.99,1.01 ]   # pinned, ± 1 %
reference = "regression"
reason = "π"

[[expect]]
measure = "L"
msm = [ # two lines ]
  0.5, # lower ]
  0.7]
reference = "regression"
reason = "r"

[[expect]]
measure = "L"
msm = [0.5, 0.7]
reference = "published"
reason = "r"
)";

std::string inline_text() {
  return std::string(text).substr(0, std::string(text).find("[[expect]]")) +
         "[[expect]]\nmeasure = \"L\"\nfem = [1, 2]\nreference = \"regression\"\nreason = \"rä\"\n";
}

/// The case with values that all three gates miss.
compare::Comparison judge_file(const std::string& path, double fem, std::optional<double> msm) {
  compare::Comparison comparison = judged::comparison({});
  comparison.scene.definition = cases::read_case(path);
  comparison.measures = {{"L", "mm", fem, msm, std::nullopt}};
  return judged::judge(comparison);
}

} // namespace

TEST_CASE("blessing moves missed regression intervals and leaves every other byte of the file") {
  const TemporaryFolder folder;
  const std::string path = folder.write("block.toml", text);
  const std::string difference = compare::bless(judge_file(path, 2.0, 1.0));
  std::string expected = case_text::replaced(text, "[ 0.99,1.01 ]", "[ 1.9900,2.0100 ]");
  expected = case_text::replaced(expected, "  0.5, # lower ]\n  0.7]", "  0.900, # lower ]\n  1.100]");
  CHECK(content(path) == expected);
  CHECK_THAT(difference, Catch::Contains("@@ -25 +25 @@\n-\tfem =   [ 0.99,1.01 ]   # pinned, ± 1 %\n"
                                         "+\tfem =   [ 1.9900,2.0100 ]   # pinned, ± 1 %\n"));
  CHECK_THAT(difference, Catch::Contains("+  1.100]\n"));
  const auto again = judge_file(path, 2.0, 1.0);
  CHECK(again.gates[0].met());
  CHECK(again.gates[1].met());
  CHECK_FALSE(again.gates[2].met()); // published: not ours to move
  CHECK(compare::bless(again).empty());
  CHECK(content(path) == expected);
}

TEST_CASE("a blessed file keeps its mode, and is found behind a link") {
  namespace fs = std::filesystem;
  const TemporaryFolder folder;
  const fs::path path = folder.write("block.toml", text), link = folder.path / "link.toml";
  const auto mode = fs::perms::owner_all | fs::perms::others_read;
  fs::permissions(path, mode);
  fs::create_symlink(path, link);
  compare::bless(judge_file(link, 2.0, 1.0));
  CHECK(fs::is_symlink(link));
  CHECK(content(path) != text);
  CHECK(fs::status(path).permissions() == mode);
}

TEST_CASE("an interval is found behind characters of several bytes, and in a file with lines of Windows") {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "block.toml", case_text::replaced(inline_text(),
                                        "[[expect]]\nmeasure = \"L\"\nfem = [1, 2]\n"
                                        "reference = \"regression\"\nreason = \"rä\"\n",
                                        "expect = [{ reason = \"ä€𝄞\", measure = \"L\", fem = [1, 2], "
                                        "reference = \"regression\" }]\n"));
  // A key of the top level cannot stand behind tables: it goes to the front.
  std::string moved = content(path);
  const std::size_t at = moved.find("expect = ");
  moved = moved.substr(at) + moved.substr(0, at);
  std::string windows;
  for (const char c : moved) windows += c == '\n' ? "\r\n" : std::string(1, c);
  for (const std::string& variant : {moved, windows}) {
    const std::string file = folder.write("variant.toml", variant);
    compare::bless(judge_file(file, 5.0, std::nullopt));
    CHECK(content(file) == case_text::replaced(variant, "[1, 2]", "[4.50, 5.50]"));
  }
}

TEST_CASE("nothing is blessed without a value, and a file that has changed meanwhile is refused") {
  const TemporaryFolder folder;
  const std::string path = folder.write("block.toml", text);
  const auto judged_before = judge_file(path, 2.0, std::nullopt);
  compare::bless(judged_before);
  CHECK(content(path) == case_text::replaced(text, "[ 0.99,1.01 ]", "[ 1.9900,2.0100 ]"));
  const std::string changed = "# a line more\n" + std::string(text);
  folder.write("block.toml", changed);
  CHECK_THROWS_AS(compare::bless(judged_before), cases::InputError);
  CHECK(content(path) == changed);
}

TEST_CASE("a case without regression intervals has nothing to bless") {
  cases::Case definition;
  definition.expectations = {judged::expectation(Quantity::msm, {0, 1}, ReferenceKind::exact)};
  CHECK_FALSE(compare::has_regression(definition));
  definition.expectations.push_back(judged::expectation(Quantity::msm, {0, 1}, ReferenceKind::regression));
  CHECK(compare::has_regression(definition));
}

TEST_CASE("an interval beyond the whole numbers of TOML is written with an exponent, and read again") {
  const TemporaryFolder folder;
  for (const double value : {1e15, 1e19, -9e307}) {
    const std::string file =
        folder.write("block.toml", case_text::replaced(inline_text(), "[1, 2]", "[-8e307, 8e307]"));
    compare::Comparison judged = judge_file(file, value, std::nullopt);
    CAPTURE(value);
    compare::bless(judged);
    CHECK_NOTHROW(cases::read_case(file));
  }
  const std::string file =
      folder.write("block.toml", case_text::replaced(inline_text(), "[1, 2]", "[-8e307, 8e307]"));
  CHECK_THROWS_WITH(compare::bless(judge_file(file, 1.5e308, std::nullopt)),
                    Catch::Contains("cannot be moved"));
}
