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

/// Keys stay in the order written.
using Json = nlohmann::ordered_json;

/// An object whose keys are the names of a value's members: {"unit": value.unit, "fem": value.fem}.
#define SPRINGPROOF_MEMBERS(value, ...)                                                                      \
  [](const auto& nlohmann_json_t) {                                                                          \
    springproof::compare::Json nlohmann_json_j;                                                              \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__))                                 \
    return nlohmann_json_j;                                                                                  \
  }(value)

/// What `to_json` makes of each record.
template<class Records, class ToJson>
Json json_list(const Records& records, const ToJson& to_json) {
  Json list = Json::array();
  for (const auto& record : records) list.push_back(to_json(record));
  return list;
}

/// A text, or null where it is empty.
inline Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

/// The document on lines of its own, in ASCII: what terminals and continuous-integration servers take for
/// commands stands as JSON's escapes. What is no UTF-8 is replaced.
inline std::string json_text(const Json& document) {
  std::string text = document.dump(2, ' ', true, Json::error_handler_t::replace) + '\n';
  for (std::size_t at = 0; (at = text.find("##", at)) != std::string::npos;)
    text.replace(at + 1, 1, "\\u0023");
  return text;
}

} // namespace springproof::compare
