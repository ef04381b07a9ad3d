#pragma once

#include <nlohmann/json.hpp>
#include <optional>

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
