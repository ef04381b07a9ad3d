#include "compare/report/html.hpp"

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <stdexcept>

using namespace springproof;

using namespace compare::html;

TEST_CASE("text on the page cannot be mistaken for markup") {
  CHECK(escape("<a href='x'>\"R&D\"</a>") == "&lt;a href=&#39;x&#39;&gt;&quot;R&amp;D&quot;&lt;/a&gt;");
}

TEST_CASE("a number is rounded and never a negative zero, and a missing one is a dash") {
  CHECK(number(-4.906) == "-4.91");
  CHECK(number(-0.004) == "0.00");
  CHECK(number(-0.4, 0) == "0");
  CHECK(number(-0.006) == "-0.01");
  CHECK(number(10.0, 0) == "10");
  CHECK(number(std::nullopt) == "–");
}

TEST_CASE("a file becomes an address that holds it as base64") {
  const TemporaryFolder folder;
  const std::string path = (folder.path / "data").string();
  // The first four are RFC 4648's own; the last has the bytes that a signed char would spoil.
  const auto [content, encoded] = GENERATE(table<std::string, std::string>(
      {{"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foobar", "Zm9vYmFy"}, {"\xff\xfe\x80", "//6A"}}));
  std::ofstream(path, std::ios::binary) << content;
  CHECK(data_address(path, "image/png") == "data:image/png;base64," + encoded);
}

TEST_CASE("a file that is not there is an error with its name") {
  CHECK_THROWS_AS(data_address("/no/such/picture.png", "image/png"), cases::InputError);
}

TEST_CASE("a template's names and values must match") {
  CHECK(fill("<p>{{a}} and {{b}} and {{a}}</p>", {{"a", "{{b}}"}, {"b", "2"}}) ==
        "<p>{{b}} and 2 and {{b}}</p>");
  CHECK_THROWS_AS(fill("{{a}} {{b}}", {{"a", "1"}}), std::logic_error);
  CHECK_THROWS_AS(fill("{{a}}", {{"a", "1"}, {"b", "2"}}), std::logic_error);
  CHECK_THROWS_AS(fill("{{a}} {{a}}", {{"a", "1"}, {"b", "2"}}),
                  std::logic_error); // not a matter of counting places
  CHECK_THROWS_AS(fill("{{a", {{"a", "1"}}), std::logic_error);
}
