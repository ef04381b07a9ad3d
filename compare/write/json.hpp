#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

/// A value that may be absent is written as null.
template<class Value>
struct nlohmann::adl_serializer<std::optional<Value>> {
  template<class Json>
  static void to_json(Json& json, const std::optional<Value>& value) {
    if (value)
      json = *value;
    else
      json = nullptr;
  }
};

namespace springproof::compare {

/// The document on lines of its own, in ASCII: what terminals and continuous-integration servers take for
/// commands stands as JSON's escapes. What is no UTF-8 is replaced.
inline std::string json_text(const nlohmann::ordered_json& document) {
  std::string text = document.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + '\n';
  for (std::size_t at = 0; (at = text.find("##", at)) != std::string::npos;)
    text.replace(at + 1, 1, "\\u0023");
  return text;
}

} // namespace springproof::compare
