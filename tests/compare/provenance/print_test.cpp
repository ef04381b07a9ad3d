#include "compare/provenance/print.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace springproof;

using compare::in_short;
using compare::n_characters;
using compare::one_line;
using compare::paragraph;

TEST_CASE("a text for people stays as it is in one line") {
  for (const std::string text :
       {"", "E = 0.3 MPa, ν = 0.35 ± 1 %", "a::b, c: d", "tab\there", "# 1", "🙂 日本"})
    CHECK(one_line(text) == text);
}

TEST_CASE("line breaks, escapes of terminals and control characters are shown as escapes") {
  CHECK(one_line("a\nb\r\nc") == "a\\nb\\r\\nc");
  CHECK(one_line("\x1b[31mred\x7f\x01") == "\\x1b[31mred\\x7f\\x01");
  CHECK(one_line("\xc2\x9b"
                 "31m") == "\\x9b31m"); // the terminal's escape as one character of UTF-8
  CHECK(one_line("\xe2\x80\xa8"
                 "x"
                 "\xe2\x80\xae") == "\\u2028x\\u202e");
  CHECK(one_line(std::string("nul\0l", 5)) == "nul\\x00l");
}

TEST_CASE("what XML cannot hold and what is no UTF-8 is shown as escapes") {
  CHECK(one_line("\xef\xbf\xbf\xef\xbf\xbe\xef\xbf\xbd") == "\\uffff\\ufffe\xef\xbf\xbd");
  CHECK(one_line("\xff\xc0\xaf") == "\\xff\\xc0\\xaf");          // no lead byte; overlong
  CHECK(one_line("\xed\xa0\x80") == "\\xed\\xa0\\x80");          // a surrogate
  CHECK(one_line("\xe2\x82") == "\\xe2\\x82");                   // cut short
  CHECK(one_line("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80"); // above U+10FFFF
}

TEST_CASE("a text does not begin a command of a continuous-integration server") {
  CHECK(one_line("::add-mask::x") == "\\x3a:add-mask::x");
  CHECK(one_line("  ::stop-commands::x") == "  \\x3a:stop-commands::x");
  CHECK(one_line("x ##[add-mask]y ##vso[task.setvariable]z") ==
        "x #\\x23[add-mask]y #\\x23vso[task.setvariable]z");
}

TEST_CASE("what is printed is escaped value by value, once and for all") {
  std::ostringstream out;
  const std::string name = "a\nb";
  compare::print(out, "{:<6}|{}|{:.1f}|{}\n", name, name.c_str(), 0.25, one_line(name));
  CHECK(out.str() == "a\\nb  |a\\nb|0.2|a\\nb\n");
}

TEST_CASE("a paragraph breaks at blanks, and no line but a longer word's is wider than it may be") {
  CHECK(paragraph("one two three four", "- ", "  ", 9) == "- one two\n  three\n  four\n");
  CHECK(paragraph("a_word_longer_than_that b", "", "", 5) == "a_word_longer_than_that\nb\n");
  CHECK(paragraph("", "x:") == "x:\n");
}

TEST_CASE("a character counts once, however many bytes it has") {
  CHECK(n_characters("45\u00b0 \u00b5m") == 6);
  CHECK(paragraph("\u00b0\u00b0\u00b0 \u00b0\u00b0\u00b0", "", "", 7) ==
        "\u00b0\u00b0\u00b0 \u00b0\u00b0\u00b0\n");
}

TEST_CASE("a text in short ends at a word, and one that fits is whole") {
  CHECK(in_short("one two three", 13) == "one two three");
  CHECK(in_short("one two three", 12) == "one two...");
  CHECK(in_short("onetwothree", 8) == "onetw...");
  for (std::size_t n = 4; n < 20; ++n)
    CHECK(n_characters(in_short("\u00b0\u00b0 \u00b0\u00b0\u00b0\u00b0 \u00b0\u00b0 lost", n)) <= n);
}

TEST_CASE("what a stranger's text would break a line with stands as an escape") {
  std::ostringstream out;
  compare::write_paragraph(out, "a\nb");
  CHECK(out.str() == "a\\nb\n");
}
