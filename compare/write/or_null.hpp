#pragma once

#include <nlohmann/json.hpp>
#include <optional>

namespace springproof::compare {

/// A value that is absent is null in JSON.
template<class Value>
nlohmann::ordered_json or_null(const std::optional<Value>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

} // namespace springproof::compare
