#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace springproof::cases {

/// The letters of ASCII small; others as they are.
inline std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

} // namespace springproof::cases
