#pragma once

#include "cases/case/error.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

using namespace springproof;

/// Case files with one thing changed, for tests of their readers.
namespace case_text {

namespace fs = std::filesystem;
using cases::InputError;

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

struct Mistake {
  std::string from, to; ///< in the good file
  int line;             ///< 0: not asked
  std::string key;
  std::vector<std::string> says;
};

/// The mistake is refused where it is made, with a message that says what is asked for.
template<class Reader>
void check_refused(const std::string& text, const Mistake& mistake, const Reader& read) {
  const TemporaryFolder folder;
  const std::string path = folder.write("case.toml", text);
  INFO("replaced: " << mistake.from << "\nby: " << mistake.to);
  try {
    read(path);
    FAIL("accepted");
  } catch (const InputError& error) {
    const std::string message = error.what();
    INFO(message);
    CHECK(error.where().file == path);
    CHECK(error.where().key == mistake.key);
    CHECK(error.where().line == mistake.line);
    const std::string begin =
        path + ":" + std::to_string(mistake.line) + ":" + std::to_string(error.where().column) + ": ";
    CHECK(message.rfind(begin + (mistake.key.empty() ? "" : mistake.key + ": "), 0) == 0);
    CHECK(error.where().column >= 1);
    for (const std::string& part : mistake.says) CHECK_THAT(message, Catch::Contains(part));
    CHECK(message.find('\n') == std::string::npos);
  }
}

} // namespace case_text
