#include "cases/case/input_file.hpp"

#include <catch2/catch.hpp>

using namespace springproof;

using cases::number_in;

// All that is read from strangers with from_chars, strtod, stoi, streams or toml++ was looked through:
// networks, displacements, recordings, curves, shards and --bless use this function; toml++ refuses what does
// not fit; headers of pictures count digits before they convert.
TEST_CASE("a number is all of its text, and fits its type") {
  CHECK(number_in<int>("12") == 12);
  CHECK(number_in<int>("-3") == -3);
  CHECK(number_in<double>("+1.5e3") == 1500);
  for (const char* text :
       {"", " 1", "1 ", "1x", "x", "+", "+-1", "4294967296", "99999999999999999999", "0x10", "1.0"}) {
    CAPTURE(text);
    CHECK_FALSE(number_in<int>(text));
  }
  for (const char* text :
       {"", "1e400", "-1e400", "1e-400", "inf", "nan", "-nan", "1,5", "1e", "0x1p3", "1 2"}) {
    CAPTURE(text);
    CHECK_FALSE(number_in<double>(text));
  }
}

TEST_CASE(
    "rows have fields without blanks and the number of their line, and the first alone may be a heading") {
  const std::string text = "# of a lab\n\na, b\r\n 1 ,2,\r\nc,d\n3";
  std::vector<std::string> read;
  const auto add = [&](const char* what) {
    return [&read, what](const cases::TextRow& row) {
      read.push_back(what + row.place());
      for (const std::string_view field : row.fields) read.back() += "[" + std::string(field) + "]";
    };
  };
  CHECK(cases::read_rows(text, "n", cases::Between::commas, add("heading "), add("")));
  CHECK(read == std::vector<std::string>{"heading n:3: [a][b]", "n:4: [1][2][]", "n:5: [c][d]", "n:6: [3]"});
  read.clear();
  CHECK_FALSE(cases::read_rows("x1 2\n3\t 4  5\n6, 7", "n", cases::Between::commas_or_blanks, add("heading "),
                               add("")));
  CHECK(read == std::vector<std::string>{"n:1: [x1][2]", "n:2: [3][4][5]", "n:3: [6][7]"});
}
