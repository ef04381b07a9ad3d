#include "compare/table/table.hpp"
#include "compare/write/quote.hpp"

#include "tests/support/unwrapped.hpp"

#include <catch2/catch.hpp>
#include <optional>
#include <sstream>

using namespace springproof;

namespace {

std::string wrapped(const std::string& text, std::size_t indent) {
  std::ostringstream out;
  compare::write_wrapped(out, text, indent);
  return out.str();
}

} // namespace

TEST_CASE("a text is broken at blanks before column 100, and loses none of its words") {
  std::string text = "  begin";
  for (int n = 0; n < 60; ++n) text += " word" + std::to_string(n);
  const std::string lines = wrapped(text, 4);
  std::istringstream in(lines);
  int n_lines = 0;
  for (std::string line; std::getline(in, line); ++n_lines) {
    CHECK(compare::n_characters(line) <= compare::screen_width);
    CHECK(line.find_first_not_of(' ') == (n_lines == 0 ? 2u : 4u));
  }
  CHECK(n_lines > 3);
  CHECK(unwrapped(lines) == text + " ");
}

TEST_CASE("a word longer than a line stands whole, on a line of its own") {
  const std::string path(150, 'p');
  CHECK(wrapped("see " + path + " there", 2) == "see\n  " + path + "\n  there\n");
}

TEST_CASE("an accented letter is one column, and a line of a stranger's text gives a terminal no command") {
  CHECK(compare::n_characters("Köhler") == 6);
  CHECK(wrapped("a\x1b[2Jb\nc", 0) == "a\\x1b[2Jb\\nc\n");
}

TEST_CASE("a table's columns are as wide as their widest text, numbers end at the right") {
  const compare::Columns columns{{"measure"}, {"mm"}, {"%"}};
  const compare::Json rows{{{"measure", "u"}, {"mm", 1.25}, {"%", nullptr}},
                           {{"measure", "a long name"}, {"mm", 3}, {"%", "+12.5"}}};
  std::ostringstream out;
  write_table(out, columns, rows);
  CHECK(out.str() == "  measure        mm      %\n"
                     "  u            1.25      -\n"
                     "  a long name     3  +12.5\n");
  CHECK(table_width(columns, rows) == 26);
}

TEST_CASE("one row makes JSON, CSV and text, and a column finds its value by a key with dots") {
  const compare::Json rows{{{"name", "u"},
                            {"cells", {2, 4}},
                            {"seconds", {{"first", {{"median", 0.12345}}}, {"again", nullptr}}},
                            {"errors", {{"a.b", -1.5}}},
                            {"stable", true},
                            {"notes", {"one", "two"}}}};
  CHECK(compare::value_at(rows[0], "cells.1") == 4);
  for (const char* absent : {"cells.2", "cells.x", "seconds.first.mean", "name.0", "again", ""})
    CHECK(compare::value_at(rows[0], absent).is_null());
  std::ostringstream csv, text;
  compare::write_csv(
      csv,
      compare::columns_of("name cells_x=cells.0 first_s=seconds.first.median again_s=seconds.again.median "
                          "error=errors.a.b stable notes"),
      rows, 3);
  CHECK(csv.str() == "name,cells_x,first_s,again_s,error,stable,notes\nu,2,0.123,,-1.5,1,one two\n");
  compare::write_table(
      text, {{"name"}, {"s", "seconds.first.median", "{:.2f}"}, {"again", "seconds.again"}, {"stable"}}, rows);
  CHECK(text.str() == "  name     s  again  stable\n"
                      "  u     0.12      -     yes\n");
}

namespace {

struct Measured {
  std::string unit;
  std::optional<double> fem;
};

} // namespace

TEST_CASE("an object has a value's members under their names, in the order given") {
  CHECK(SPRINGPROOF_MEMBERS((Measured{"mm", std::nullopt}), fem, unit).dump() ==
        R"({"fem":null,"unit":"mm"})");
}

TEST_CASE("a row has numbers to the writer's digits, texts in quotes where needed, nothing for no value") {
  std::ostringstream out;
  compare::CsvWriter csv(out, 3);
  csv.row(1.23456, 7, "a,b", "say \"so\"", std::optional<double>(), std::vector<double>{0.5, 2});
  CHECK(out.str() == "1.23,7,\"a,b\",\"say \"\"so\"\"\",,0.5,2\n");
}

TEST_CASE("a text is no formula of a spreadsheet's") {
  std::ostringstream out;
  compare::CsvWriter(out).row("=1+1", "@x", "+y", "-2+cmd|x", "-", -2.5, "a=b", "-2.5");
  CHECK(out.str() == "'=1+1,'@x,'+y,'-2+cmd|x,'-,-2.5,a=b,-2.5\n");
}

TEST_CASE("a text makes no second line in a row, and no escape of a terminal") {
  std::ostringstream out;
  compare::CsvWriter(out).row("case\n::add-mask::x", "\x1b[2J");
  CHECK(out.str() == "case\\n::add-mask::x,\\x1b[2J\n");
}

TEST_CASE("a command's words are quoted so that a shell takes them as they were") {
  CHECK(compare::shell_line({"springproof", "run", "a b.toml", "--set", "x='$(rm)'", ""}) ==
        R"(springproof run 'a b.toml' --set 'x='\''$(rm)'\''' '')");
}
