#pragma once

#include <string>

/// A text without the line breaks that keep it in a terminal's width: each counts as a blank.
inline std::string unwrapped(const std::string& text) {
  std::string result;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] != '\n') {
      result += text[at];
      continue;
    }
    const std::size_t next = text.find_first_not_of(' ', at + 1);
    result += ' ';
    at = (next == std::string::npos ? text.size() : next) - 1;
  }
  return result;
}
