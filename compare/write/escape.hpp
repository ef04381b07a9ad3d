#pragma once

#include <map>
#include <string>

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

} // namespace springproof::compare
