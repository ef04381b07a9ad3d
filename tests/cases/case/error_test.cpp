#include "cases/case/error.hpp"

#include <catch2/catch.hpp>
#include <string>

using namespace springproof;

using cases::InputError;

TEST_CASE("an input error says where, which key, and what is wrong") {
  const InputError error({"cube.toml", 12, 5, "load[0].value"}, "is empty");
  CHECK(std::string(error.what()) == "cube.toml:12:5: load[0].value: is empty");
}

TEST_CASE("an input error from the command line has no line") {
  const InputError error({"", 0, 0, "fem.refine"}, "is not a number");
  CHECK(std::string(error.what()) == "command line: fem.refine: is not a number");
}
