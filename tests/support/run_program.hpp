#pragma once

#include "tests/support/temporary_folder.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <sys/wait.h>

struct ProgramRun {
  int status; ///< exit status; -1 if a signal ended it
  std::string out, error;
};

/// Shell words that go to the project's folder, for paths as a user types them.
inline const std::string in_source = "cd '" SPRINGPROOF_SOURCE_DIR "' && ";

/// Runs build/springproof through the shell.
/// @param words  text typed behind the program's name      @param before  shell commands in front of it
inline ProgramRun run_program(const std::string& words, const std::string& before = "") {
  const TemporaryFolder folder;
  const std::string errors = (folder.path / "stderr").string();
  FILE* pipe = popen((before + SPRINGPROOF_PROGRAM " " + words + " 2>" + errors).c_str(), "r");
  REQUIRE(pipe);
  std::string out;
  std::array<char, 4096> block{};
  while (const std::size_t n = fread(block.data(), 1, block.size(), pipe)) out.append(block.data(), n);
  const int status = pclose(pipe);
  ProgramRun run{WIFEXITED(status) ? WEXITSTATUS(status) : -1, out, content(errors)};
  UNSCOPED_INFO("springproof " << words << "\n" << run.error); // shown with a check that fails
  return run;
}

/// Standard output of a command, which must end with status 0.
inline std::string printed_by(const std::string& words, const std::string& before = "") {
  const ProgramRun run = run_program(words, before);
  REQUIRE(run.status == 0);
  return run.out;
}

/// The document that a command prints, and nothing else.
inline nlohmann::json document_of(const std::string& words, const std::string& before = "") {
  const ProgramRun run = run_program(words, before);
  REQUIRE(run.status == 0);
  CHECK(run.error.empty());
  return nlohmann::json::parse(run.out);
}

/// Requires that a command is refused: exit status 2, no result, and a message of one line, or of two where
/// the second tells of --help.
inline void check_refused(const std::string& words, const std::string& says, const std::string& before = "") {
  const ProgramRun run = run_program(words, before);
  CHECK(run.status == 2);
  CHECK(run.out.empty());
  CHECK_THAT(run.error, Catch::Contains(says));
  CHECK(std::count(run.error.begin(), run.error.end(), '\n') <=
        (run.error.find("--help") < run.error.size() ? 2 : 1));
}
