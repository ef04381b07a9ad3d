#include "compare/thesis/write.hpp"

#include "compare/provenance/print.hpp"
#include "compare/thesis/figures.hpp"
#include "tests/support/screen.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

using namespace springproof;
using Catch::Contains;
using compare::TableEntry;
using Points = std::vector<Eigen::Vector3d>;

namespace {

TableEntry entry(const std::string& table, double poissons_ratio, const std::string& measure) {
  return {{table, "linear_elastic", poissons_ratio, "linear_method", poissons_ratio, "small", "shear",
           measure, "%", 0},
          {{}},
          ""};
}

/// A figure that print gives as 10 %, with a value for each reference.
TableEntry valued(const std::vector<std::optional<double>>& values) {
  TableEntry result = entry("4.6", 0.3, "alpha_2");
  result.published.value = 10;
  result.computed.clear();
  for (const auto& value : values) result.computed.push_back({"log_strain q1_bbar", value});
  return result;
}

/// Every published figure, each off by as much as any may be, and advice for five ratios.
compare::ThesisResults everything() {
  compare::ThesisResults results;
  for (const compare::PublishedFigure& figure : compare::published_figures()) {
    TableEntry one{figure, {{"log_strain q1_bbar", figure.value - 123.45}}, ""};
    if (figure.test != "cell") one.computed.push_back({"small_strain q1_bbar", figure.value + 99.99});
    if (figure.test == "cell") one.computed[0].value = figure.value + 0.0004;
    results.entries.push_back(one);
  }
  for (const double nu : {0.2, 0.3, 0.35, 0.45, 0.49}) {
    compare::Advice advice{nu, "nonlinear_method"};
    advice.cube.small = {1234.5, 100., 100., true};
    advice.cube.large = {1234.5, 100., 100., true};
    advice.is_recommended = true;
    results.advice.push_back(advice);
  }
  return results;
}

std::string text_of(const compare::ThesisResults& results, const std::string& folder = "") {
  std::ostringstream out;
  write_tables_text(out, results);
  write_where_text(out, results, folder);
  return out.str();
}

/// The blocks of a gnuplot data file: lines of numbers, parted by blank lines, in blocks parted by two.
std::vector<std::vector<std::string>> blocks_of(const std::filesystem::path& path) {
  std::vector<std::vector<std::string>> blocks(1);
  std::ifstream file(path);
  int n_blank = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.empty()) {
      ++n_blank;
      continue;
    }
    if (n_blank >= 2) blocks.emplace_back();
    n_blank = 0;
    if (line[0] != '#') blocks.back().push_back(line);
  }
  return blocks;
}

} // namespace

TEST_CASE("entries become tables in the order of print, and each has its place") {
  const std::vector<TableEntry> entries{entry("4.5", 0.2, "alpha_1"), entry("4.5", 0.25, "alpha_1"),
                                        entry("4.5", 0.25, "alpha_2"), entry("4.6", 0.2, "alpha_1")};
  const std::vector<compare::Sheet> sheets = compare::sheets_of(entries);
  REQUIRE(sheets.size() == 2);
  CHECK(name_of(sheets[0]) == "Table 4.5");
  REQUIRE(sheets[0].rows.size() == 2);
  REQUIRE(sheets[0].columns.size() == 2);
  CHECK(sheets[0].rows[0].cells == std::vector{&entries[0], &entries[1]});
  CHECK(sheets[0].rows[1].cells == std::vector<const TableEntry*>{nullptr, &entries[2]}); // not printed
  CHECK(sheets[0].rows[1].first == &entries[2]);
  CHECK(sheets[1].rows[0].cells == std::vector{&entries[3]});
}

TEST_CASE("a cell has the value of the declared reference, its difference, and a mark when print is nearer "
          "to another") {
  CHECK(compare::cell_text(valued({10.25, 12})) == "10.25   +0.25 ");
  CHECK(compare::cell_text(valued({12, 9.5})) == "12.00   +2.00*");
  CHECK(compare::cell_text(valued({10, 12})) == "10.00   +0.00 ");
  CHECK(compare::cell_text(valued({12, std::nullopt})) == "12.00   +2.00!");
}

TEST_CASE("a failed solve is a failed cell, counted apart, with its reason in short") {
  compare::ThesisResults results;
  results.entries = {valued({10.5, 12}), valued({14, 13}), valued({std::nullopt, 10}),
                     valued({10, std::nullopt})};
  for (std::size_t e : {2, 3}) results.entries[e].published.measure += std::to_string(e); // rows of their own
  results.entries[2].computed[0].reason = "springs: no equilibrium " + std::string(200, '.');
  results.entries[3].computed[1].reason = "finite elements: diverged";
  CHECK(compare::cell_text(results.entries[2]) == "failed");
  const std::string text = text_of(results);
  CHECK_THAT(text, Contains("4 published values: 1 reproduced, 1 not, 2 failed")); // within 1 point
  CHECK_THAT(text, Contains("failed: 4.6 shear alpha_22") && Contains("failed: 4.6 shear alpha_23"));
  CHECK_THAT(text, Contains("springs: no") && !Contains(std::string(200, '.')));
  CHECK_THAT(text, Contains("errors, beta_1 aside: 1 of 4 within 1 point"));
  CHECK(width_of_text(text) <= compare::screen_width);
}

TEST_CASE("all tables, the counts and the advice stand on 120 lines of 100 characters") {
  const std::string text = text_of(everything(), "out");
  INFO(text);
  CHECK(lines_of_text(text).size() <= 120);
  CHECK(width_of_text(text) <= 100);
  for (const std::string& table : compare::tables_of(compare::published_figures()))
    CHECK_THAT(text, Contains((table == "5.12" ? "Figure " : "Table ") + table + ": "));
}

TEST_CASE("measures stand down and Poisson's ratios across, as in print") {
  const std::vector<std::string> lines = lines_of_text(text_of(everything()));
  const auto table = std::find_if(lines.begin(), lines.end(),
                                  [](const std::string& line) { return line.rfind("Table 4.5", 0) == 0; });
  REQUIRE(lines.end() - table > 7);
  CHECK_THAT(table[1], Contains("nu = 0.2 ") && Contains("nu = 0.25 ") && Contains("nu = 0.49"));
  const std::vector<std::string> measures{"L_1", "L_2", "alpha_1", "alpha_2", "beta_1 (!)", "beta_2"};
  for (std::size_t m = 0; m < measures.size(); ++m) CHECK(table[2 + m].rfind("  " + measures[m], 0) == 0);
}

TEST_CASE("where the audit is: its files with a folder, what to type without") {
  CHECK_THAT(text_of(everything()), Contains("springproof tables --trace"));
  CHECK_THAT(text_of(everything(), "results"),
             Contains("audit.txt") && Contains("tables.csv") && Contains("results"));
}

TEST_CASE("the advice tells what a case takes that names no design") {
  compare::ThesisResults results = everything();
  compare::Advice by_default = results.advice[3]; // nu = 0.45
  by_default.design = "hybrid";
  by_default.is_recommended = false;
  results.advice.push_back(by_default);
  CHECK_THAT(text_of(results),
             Contains("hybrid") && Contains("A case of forces on nodes that names no design"));
  results.advice = {by_default};
  results.advice.front().is_recommended = true;
  CHECK_THAT(text_of(results), Contains("the same") && !Contains("that names no design"));
}

TEST_CASE("a figure of bodies holds the faces and edges that look at the viewer, displaced") {
  const TemporaryFolder folder;
  const cases::Mesh mesh = cases::make_box_mesh({1, 1, 1}, {{1, 1, 1}});
  const Points fem(8, {0, 0, 0.5}), springs(8, {2, 0, 0});
  compare::plot_bodies(folder.path.string(), "cube", {{"one", {&mesh, &fem}, {&mesh, &springs}}}, 1);
  const auto blocks = blocks_of(folder.path / "cube.csv");
  REQUIRE(blocks.size() == 3);
  CHECK(blocks[0].size() == 3 * 5); // three faces of a cube are seen: closed polygons
  CHECK(blocks[1].size() == 9 * 2); // and nine edges, each drawn once
  CHECK(blocks[2].size() == 9 * 2); // all of them sharp
  const auto has = [](const std::vector<std::string>& lines, const std::string& start) {
    for (const std::string& line : lines)
      if (line.rfind(start, 0) == 0) return true;
    return false;
  };
  CHECK(has(blocks[0], "1.0000,0.0000,1.5000,"));
  CHECK(has(blocks[1], "3.0000,0.0000,1.0000,"));
  CHECK(has(blocks[2], "1.0000,0.0000,1.0000,"));
  CHECK_FALSE(has(blocks[0], "0.0000,1.0000,0.5000,")); // the hidden corner
  for (const char* file : {"cube.svg", "cube.png", "cube.gp"})
    CHECK(std::filesystem::file_size(folder.path / file) > 100);
}

TEST_CASE("a body without an equilibrium leaves its place in the figure empty") {
  const TemporaryFolder folder;
  const cases::Mesh mesh = cases::make_box_mesh({1, 1, 1}, {{1, 1, 1}});
  const Points fem(8, {0, 0, 0.5}), none;
  compare::plot_bodies(folder.path.string(), "cube", {{"one", {&mesh, &fem}, {&mesh, &none}}}, 1);
  const auto blocks = blocks_of(folder.path / "cube.csv");
  REQUIRE(blocks.size() == 3);
  CHECK(blocks[1] == std::vector<std::string>{"?,?,?,?,?"});
}
