#pragma once

#include "compare/write/quote.hpp"

#include <fstream>
#include <string>
#include <vector>

namespace springproof::compare {

/// This process's command as it was typed, quoted for a shell; empty where the system does not tell.
inline std::string typed_command() {
  std::ifstream in("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(in, word, '\0');) words.push_back(word);
  return shell_line(words);
}

} // namespace springproof::compare
