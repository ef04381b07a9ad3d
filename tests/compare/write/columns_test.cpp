#include "compare/write/columns.hpp"
#include "compare/write/shell.hpp"

#include "tests/support/unwrapped.hpp"

#include <catch2/catch.hpp>
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
    CHECK(compare::printed_width(line) <= compare::screen_width);
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
  CHECK(compare::printed_width("Köhler") == 6);
  CHECK(wrapped("a\x1b[2Jb\nc", 0) == "a\\x1b[2Jb\\nc\n");
}

TEST_CASE("a table's columns are as wide as their widest text, numbers end at the right") {
  compare::TextTable table({{"measure", compare::TextTable::Side::left}, {"mm"}, {"%"}});
  table.add({"u", "1.25", "-"});
  table.add({"a long name", "3", "+12.5"});
  std::ostringstream out;
  table.write(out);
  CHECK(out.str() == "  measure        mm      %\n"
                     "  u            1.25      -\n"
                     "  a long name     3  +12.5\n");
  CHECK(table.width() == 26);
}

TEST_CASE("a command's words are quoted so that a shell takes them as they were") {
  CHECK(compare::shell_line({"springproof", "run", "a b.toml", "--set", "x='$(rm)'", ""}) ==
        R"(springproof run 'a b.toml' --set 'x='\''$(rm)'\''' '')");
}
