#pragma once

#include <map>
#include <string>
#include <vector>

/// Texts as other languages take them.
namespace springproof::compare {

/// A text with other texts in place of some of its characters.
inline std::string escaped(const std::string& text, const std::map<char, std::string>& by) {
  std::string result;
  for (const char c : text) {
    const auto found = by.find(c);
    if (found == by.end())
      result += c;
    else
      result += found->second;
  }
  return result;
}

/// Text as it may stand between the tags of HTML and XML and inside an attribute, in either kind of quotes.
inline std::string escape(const std::string& text) {
  return escaped(text, {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}});
}

/// Words as a shell takes them again: what is more than letters, digits and _-./=+:, stands in quotes.
inline std::string shell_line(const std::vector<std::string>& words) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+:,";
  std::string line;
  for (const std::string& word : words) {
    const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
    line += (line.empty() ? "" : " ") + (is_plain ? word : "'" + escaped(word, {{'\'', "'\\''"}}) + "'");
  }
  return line;
}

} // namespace springproof::compare
