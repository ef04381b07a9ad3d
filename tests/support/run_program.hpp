#pragma once

#include "tests/support/temporary_folder.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>
#include <sys/wait.h>

struct ProgramRun {
  int status; ///< exit status; -1 if a signal ended it
  std::string out, error;
};

/// Runs build/springproof through the shell.
/// @param words  as typed behind the program's name      @param before  shell commands in front of it
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
