#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

/// The lines of a text.
inline std::vector<std::string> lines_of_text(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Characters of the widest line; bytes of UTF-8 that go on with a character are none.
inline std::size_t width_of_text(const std::string& text) {
  std::size_t widest = 0;
  for (const std::string& line : lines_of_text(text))
    widest = std::max(widest, static_cast<std::size_t>(std::count_if(line.begin(), line.end(), [](char c) {
                        return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
                      })));
  return widest;
}

/// Whether a text has a word of capitals alone, of three letters or more, that is not among those allowed.
inline bool has_shouting(const std::string& text, const std::vector<std::string>& allowed) {
  std::string word;
  for (const char c : text + " ") {
    if (c >= 'A' && c <= 'Z') {
      word += c;
      continue;
    }
    const bool is_word = !((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_');
    if (is_word && word.size() > 2 && std::find(allowed.begin(), allowed.end(), word) == allowed.end())
      return true;
    word.clear();
  }
  return false;
}
