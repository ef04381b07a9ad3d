#include "compare/provenance/paragraph.hpp"

#include <catch2/catch.hpp>
#include <sstream>

using namespace springproof;

TEST_CASE("a paragraph breaks at blanks, and no line but a longer word's is wider than it may be") {
  CHECK(compare::paragraph("one two three four", "- ", "  ", 9) == "- one two\n  three\n  four\n");
  CHECK(compare::paragraph("a_word_longer_than_that b", "", "", 5) == "a_word_longer_than_that\nb\n");
  CHECK(compare::paragraph("", "x:") == "x:\n");
}

TEST_CASE("a character counts once, however many bytes it has") {
  CHECK(compare::n_characters("45\u00b0 \u00b5m") == 6);
  CHECK(compare::paragraph("\u00b0\u00b0\u00b0 \u00b0\u00b0\u00b0", "", "", 7) ==
        "\u00b0\u00b0\u00b0 \u00b0\u00b0\u00b0\n");
}

TEST_CASE("a text in short ends at a word, and one that fits is whole") {
  CHECK(compare::in_short("one two three", 13) == "one two three");
  CHECK(compare::in_short("one two three", 12) == "one two...");
  CHECK(compare::in_short("onetwothree", 8) == "onetw...");
  for (std::size_t n = 4; n < 20; ++n)
    CHECK(compare::n_characters(
              compare::in_short("\u00b0\u00b0 \u00b0\u00b0\u00b0\u00b0 \u00b0\u00b0 lost", n)) <= n);
}

TEST_CASE("what a stranger's text would break a line with stands as an escape") {
  std::ostringstream out;
  compare::write_paragraph(out, "a\nb");
  CHECK(out.str() == "a\\nb\n");
}
