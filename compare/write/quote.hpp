#pragma once

#include <map>
#include <string>
#include <vector>

/// Texts as other languages take them.
namespace springproof::compare {

/// Text as it may stand between the tags of HTML and XML and inside an attribute, in either kind of quotes.
inline std::string escape(const std::string& text) {
  static const std::map<char, std::string> entities{
      {'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&#39;"}};
  std::string result;
  for (const char c : text) {
    const auto entity = entities.find(c);
    result += entity == entities.end() ? std::string(1, c) : entity->second;
  }
  return result;
}

/// Words as a shell takes them again: what is more than letters, digits and _-./=+:, stands in quotes.
inline std::string shell_line(const std::vector<std::string>& words) {
  const std::string plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./=+:,";
  std::string line;
  for (const std::string& word : words) {
    std::string quoted;
    for (const char c : word) quoted += c == '\'' ? "'\\''" : std::string(1, c);
    const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string::npos;
    line += (line.empty() ? "" : " ") + (is_plain ? word : "'" + quoted + "'");
  }
  return line;
}

} // namespace springproof::compare
